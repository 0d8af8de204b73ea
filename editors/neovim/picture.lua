-- What the picture shows: the findings of a model, and what is known about its surface.

vim.o.termguicolors = true
vim.o.number = true
vim.o.signcolumn = "yes"
vim.o.laststatus = 0
vim.o.ruler = false
vim.cmd([[
  colorscheme slate
  highlight Normal guibg=#1e2228 guifg=#d8dee9
  highlight NormalFloat guibg=#2b303b guifg=#d8dee9
  highlight SignColumn guibg=#1e2228
  highlight LineNr guibg=#1e2228 guifg=#5b6474
  highlight Comment guifg=#7b8494
  highlight Constant guifg=#d8a0df
  highlight Delimiter guifg=#a0a8b8
  highlight Function guifg=#ebcb8b
  highlight Identifier guifg=#d8dee9
  highlight Keyword guifg=#81a1f1 gui=bold
  highlight Label guifg=#e0b070 gui=italic
  highlight Operator guifg=#a0a8b8
  highlight Special guifg=#88c0d0
  highlight Type guifg=#8fcf8b
  highlight DiagnosticError guifg=#ff7b72
  highlight DiagnosticWarn guifg=#e0b050
  highlight DiagnosticInfo guifg=#79c0ff
]])

local function first_line(finding)
  return finding.message:match("[^\n]*")
end
vim.diagnostic.config({ severity_sort = true, virtual_text = { prefix = "▪", format = first_line } })

vim.cmd("edit racecar.fdc")
vim.wait(8000, function()
  return #vim.diagnostic.get(0) > 2
end, 50)
vim.fn.search("^surface slip")
vim.cmd("normal! w")
vim.fn.winrestview({ topline = 18 })
vim.defer_fn(vim.lsp.buf.hover, 300)
