-- How models are edited: comments, indentation, and colours by tree-sitter where its parser has been compiled.

local set = vim.opt_local
set.commentstring = "# %s"
set.comments = ":#!,:#"
set.expandtab = true
set.shiftwidth = 2
set.softtabstop = 2
set.indentexpr = "v:lua.fdc_indent()"
set.indentkeys = "0},o,O"
set.omnifunc = "v:lua.vim.lsp.omnifunc"

-- A line stands as the one before it, further in behind an opening brace and further out before a closing one.
function _G.fdc_indent()
  local before = vim.fn.prevnonblank(vim.v.lnum - 1)
  local function code(number)
    return (vim.fn.getline(number):gsub("#.*", ""))
  end
  local opens = code(before):match("{[^}]*$") and 1 or 0
  local closes = code(vim.v.lnum):match("^%s*}") and 1 or 0
  return vim.fn.indent(before) + (opens - closes) * vim.fn.shiftwidth()
end

if #vim.api.nvim_get_runtime_file("parser/fdc.*", false) > 0 then
  if vim.treesitter.start then
    vim.treesitter.start()
  else
    vim.treesitter.highlighter.new(vim.treesitter.get_parser(0, "fdc"))
  end
end
