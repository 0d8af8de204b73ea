-- How the language server is started, as Neovim 0.11 reads it and `plugin/fdc.lua` hands it to older ones.

return {
  cmd = { "fdcc", "lsp" },
  filetypes = { "fdc" },
  root_markers = { ".git" },
}
