-- A model is edited in a real Neovim, without a screen: run by `editors/neovim/test`, in the folder of the repository.
--
-- A race car with two mistakes is opened. Its diagnostics are seen and repaired, a surface is renamed, the layout is
-- put in order, and what comes out is the race car of `models/` again.

local original = table.concat(vim.fn.readfile("models/racecar.fdc"), "\n") .. "\n"
local broken = original:gsub("muN%*Sgn", "muM*Sgn"):gsub("state th%s+start 0", "state th start 0   \nstate unused start 0")

local function check(truth, what, seen)
  if not truth then
    print(("FAILED: %s: %s\n"):format(what, vim.inspect(seen)))
    vim.cmd("cquit 1")
  end
  print(("ok: %s\n"):format(what))
end

local function text()
  return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, true), "\n") .. "\n"
end

-- Where a text stands, from 0, as the protocol counts; the cursor is put there.
local function go_to(wanted)
  for line, content in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, true)) do
    local column = content:find(wanted, 1, true)
    if column then
      vim.api.nvim_win_set_cursor(0, { line, column - 1 })
      return line - 1
    end
  end
  check(false, "the text is there", wanted)
end

local function codes()
  local found = vim.tbl_map(function(one)
    return one.code
  end, vim.diagnostic.get(0))
  table.sort(found)
  return found
end

local function wait_for(what, condition)
  vim.wait(10000, condition, 20)
  check(condition(), what, codes())
end

local function ask(method, params)
  local answers = vim.lsp.buf_request_sync(0, method, params or vim.lsp.util.make_position_params(), 10000)
  local _, answer = next(answers or {})
  check(answer and not answer.error, method .. " is answered", answer)
  return answer.result
end

local function apply(edit)
  local client = (vim.lsp.get_clients or vim.lsp.get_active_clients)()[1]
  vim.lsp.util.apply_workspace_edit(edit, client.offset_encoding or "utf-16")
end

vim.fn.writefile(vim.split(broken, "\n"), "target/editors/broken.fdc", "b")
vim.cmd("edit target/editors/broken.fdc")
check(vim.bo.filetype == "fdc", "a model is recognised", vim.bo.filetype)

wait_for("mistakes are shown", function()
  return vim.tbl_contains(codes(), "FDC0101")
end)
local mistake = vim.tbl_filter(function(one)
  return one.code == "FDC0101"
end, vim.diagnostic.get(0))[1]
check(mistake.lnum == go_to("muM*Sgn") and mistake.message:find("muM"), "the mistake stands at its line", mistake)

go_to("muM*Sgn")
local range = vim.lsp.util.make_range_params()
range.context = { diagnostics = vim.lsp.diagnostic.get_line_diagnostics() }
local actions = ask("textDocument/codeAction", range)
check(#actions > 0 and actions[1].edit, "a repair is offered", actions)
apply(actions[1].edit)
check(text():find("muN*Sgn", 1, true), "the repair is applied", text())

go_to("state unused")
vim.api.nvim_del_current_line()
wait_for("advice is all that is left", function()
  local grave = { severity = { min = vim.diagnostic.severity.WARN } }
  return #codes() > 0 and #vim.diagnostic.get(0, grave) == 0
end)

go_to("slip = dot")
local hover = ask("textDocument/hover")
check(hover and vim.inspect(hover):find("surface"), "a surface is explained", hover)

local definition = (go_to("slip)*across") and ask("textDocument/definition"))
check(vim.inspect(definition):find("line = " .. go_to("surface slip")), "its definition is found", definition)

go_to("slip = dot")
local rename = vim.lsp.util.make_position_params()
rename.newName = "skid"
apply(ask("textDocument/rename", rename))
check(not text():find("slip"), "it is renamed everywhere", text())

local format = vim.lsp.util.make_formatting_params({})
vim.lsp.util.apply_text_edits(ask("textDocument/formatting", format), 0, "utf-16")
check(text():gsub("skid", "slip") == original, "the model is laid out again", text())

vim.cmd("normal! Goguess {\rT = 5\r}\rend T >= 1")
local indents = vim.tbl_map(vim.fn.indent, { vim.fn.line("$") - 2, vim.fn.line("$") - 1, vim.fn.line("$") })
check(vim.deep_equal(indents, { 2, 0, 0 }), "lines between braces are further in", indents)

if vim.treesitter.highlighter.active[vim.api.nvim_get_current_buf()] then
  local query = (vim.treesitter.query.get or vim.treesitter.get_query)("fdc", "highlights")
  local text_of = vim.treesitter.get_node_text or vim.treesitter.query.get_node_text
  local tree = vim.treesitter.get_parser(0, "fdc"):parse()[1]
  local colours = {}
  for id, node in query:iter_captures(tree:root(), 0) do
    colours[text_of(node, 0)] = query.captures[id]
  end
  local expected = { state = "keyword", atan2 = "function.builtin", skid = "label", ["0.5"] = "constant.numeric" }
  for word, colour in pairs(expected) do
    check(colours[word] == colour, ("`%s` has the colour of a %s"):format(word, colour), colours[word])
  end
end

vim.cmd("qall!")
