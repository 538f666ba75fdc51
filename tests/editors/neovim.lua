-- Fathom in Neovim itself, without a window (scripts/editors.sh): nvim --clean --headless -u neovim.lua
-- with FATHOM_ROOT, FATHOM_PROGRAM and, to write into, an empty folder FATHOM_WORK.
local root, work = vim.env.FATHOM_ROOT, vim.env.FATHOM_WORK

local function demand(holds, what)
  if holds then return end
  io.stderr:write("neovim: " .. what .. "\n")
  vim.cmd("cquit!")
end

local function ask(method, params)
  for _, answer in pairs(vim.lsp.buf_request_sync(0, method, params, 10000) or {}) do
    demand(not answer.error, method .. " failed")
    return answer.result
  end
  demand(false, method .. " has no answer")
end

local function main()
  vim.opt.runtimepath:append(root .. "/editors/vim")
  vim.opt.runtimepath:append(root .. "/editors/neovim")
  vim.cmd("filetype plugin indent on | syntax on")
  require("fathom").setup({ cmd = { vim.env.FATHOM_PROGRAM, "lsp" } })
  local file = io.open(work .. "/a.sdf", "w")
  file:write("let r = 1\nbox([r, 3, r]).twist(0.4, axis: Y)\ntorus(2, 0.1)\n")
  file:close()
  vim.cmd("edit " .. work .. "/a.sdf")
  demand(vim.bo.filetype == "fathom", "the file type is " .. vim.bo.filetype)

  local hints = vim.api.nvim_get_namespaces().fathom_hints
  local marks = function() return vim.api.nvim_buf_get_extmarks(0, hints, 0, -1, { details = true }) end
  demand(vim.wait(10000, function() return #marks() == 2 end), "two lines have hints")
  demand(marks()[1][4].virt_text[1][1]:find("bound 1.1"), "the bound is shown")

  local line
  vim.api.nvim_win_set_cursor(0, { 2, 1 })
  local hover = ask("textDocument/hover", vim.lsp.util.make_position_params())
  demand(hover.contents.value:find("This shape: bound 1.1", 1, true), "hover says the bound")

  vim.api.nvim_win_set_cursor(0, { 2, 16 })
  hover = ask("textDocument/hover", vim.lsp.util.make_position_params())
  demand(hover.contents.value:find("`twist` here: bound 1.1", 1, true), "a call says its bound")
  require("fathom").slide(5)
  line = vim.api.nvim_buf_get_lines(0, 1, 2, false)[1]
  demand(line:find("twist(0.9,", 1, true), "the number is another: " .. line)
  vim.cmd("undo")

  vim.api.nvim_win_set_cursor(0, { 1, 4 })
  local params = vim.lsp.util.make_position_params()
  params.newName = "width"
  vim.lsp.util.apply_workspace_edit(ask("textDocument/rename", params), "utf-16")
  line = vim.api.nvim_buf_get_lines(0, 1, 2, false)[1]
  demand(line:find("box([width, 3, width])", 1, true), "the name is another: " .. line)

  vim.api.nvim_buf_set_lines(0, 2, 3, false, { "shpere(1)" })
  demand(vim.wait(10000, function() return #vim.diagnostic.get(0) == 1 end), "one error is shown")
  demand(vim.diagnostic.get(0)[1].lnum == 2, "the error is in line 3")
  -- a click in the window of a text that is not saved
  require("fathom").clicked(nil, { uri = vim.uri_from_bufnr(0), position = { line = 1, character = 4 } })
  local cursor = vim.api.nvim_win_get_cursor(0)
  demand(cursor[1] == 2 and cursor[2] == 4, "a click puts the cursor at its place")
  print("neovim: hints, hover, rename and errors are right\n")
  vim.cmd("qall!")
end

local ok, failure = pcall(main)
demand(ok, tostring(failure))
