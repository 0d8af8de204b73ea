-- Starts the language server for `.fdc` models, in the way of each version of Neovim.

-- What the server tells apart by meaning; Neovim has colours of its own for the usual kinds only.
local colours = {
  state = "Identifier",
  control = "Special",
  param = "Constant",
  constant = "Constant",
  free = "PreProc",
  surface = "Label",
  jump = "Label",
  phase = "Label",
  constraint = "Label",
  unit = "Type",
}
if vim.lsp.semantic_tokens then
  for kind, group in pairs(colours) do
    vim.api.nvim_set_hl(0, "@lsp.type." .. kind .. ".fdc", { link = group, default = true })
  end
end

-- Units that were found, and what the last solve said, behind the lines they are about.
if vim.lsp.inlay_hint then
  vim.api.nvim_create_autocmd("LspAttach", {
    callback = function(event)
      local client = vim.lsp.get_client_by_id(event.data.client_id)
      if client and client.name == "fdcc" then
        vim.lsp.inlay_hint.enable(true, { bufnr = event.buf })
      end
    end,
  })
end

if vim.lsp.enable then
  vim.lsp.enable("fdcc")
  return
end

local folder = vim.fn.fnamemodify(debug.getinfo(1, "S").source:sub(2), ":p:h:h")
local config = dofile(folder .. "/lsp/fdcc.lua")
local client

-- Neovim 0.7 keeps no list of servers by name: the one of the first model serves all.
local function attach(buffer)
  if vim.lsp.start then
    vim.lsp.start({ name = "fdcc", cmd = config.cmd }, { bufnr = buffer })
    return
  end
  if not (client and vim.lsp.get_client_by_id(client)) then
    client = vim.lsp.start_client({ name = "fdcc", cmd = config.cmd })
  end
  if client then
    vim.lsp.buf_attach_client(buffer, client)
  end
end

vim.api.nvim_create_autocmd("FileType", {
  pattern = config.filetypes,
  callback = function(event)
    attach(event.buf)
  end,
})
