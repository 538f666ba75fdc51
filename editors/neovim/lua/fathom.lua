-- Fathom in Neovim 0.7 and later: starts the server for texts of the file type `fathom`, and shows
-- the hints (bounds, names of arguments) as virtual text. The syntax, the indentation and the file
-- type are those of editors/vim.
--
--   require("fathom").setup({ cmd = { "fathom", "lsp" } })
--
-- `:FathomShow` opens a window of the viewer that follows the buffer as it is typed. The cursor
-- outlines the shape that it stands in, a click there puts the cursor at its line, and `<M-Up>`,
-- `<M-Down>` change the number under the cursor; of a `param` without another compilation.

local M = {}
local hints = vim.api.nvim_create_namespace("fathom_hints")

-- Asks for the hints of a whole buffer and draws them at the ends of their lines.
function M.show_hints(buffer, client)
  local last = vim.api.nvim_buf_line_count(buffer)
  local params = {
    textDocument = { uri = vim.uri_from_bufnr(buffer) },
    range = { start = { line = 0, character = 0 }, ["end"] = { line = last, character = 0 } },
  }
  client.request("textDocument/inlayHint", params, function(failed, found)
    if failed or not found or not vim.api.nvim_buf_is_valid(buffer) then return end
    vim.api.nvim_buf_clear_namespace(buffer, hints, 0, -1)
    local lines = {}
    for _, hint in ipairs(found) do
      local line = hint.position.line
      lines[line] = (lines[line] and lines[line] .. "  " or "") .. hint.label
    end
    for line, text in pairs(lines) do
      if line < vim.api.nvim_buf_line_count(buffer) then
        vim.api.nvim_buf_set_extmark(buffer, hints, line, 0, { virt_text = { { text, "Comment" } } })
      end
    end
  end, buffer)
end

-- Opens the window of a buffer; from then on the cursor is told.
function M.show(buffer, client)
  local document = { uri = vim.uri_from_bufnr(buffer) }
  client.request("fathom/preview", { textDocument = document }, function(failed)
    if failed then vim.notify("fathom: " .. failed.message, vim.log.levels.WARN) return end
    vim.api.nvim_create_autocmd({ "CursorMoved", "CursorMovedI" }, {
      group = vim.api.nvim_create_augroup("fathom_cursor_" .. buffer, {}),
      buffer = buffer,
      callback = function() client.notify("fathom/cursor", vim.lsp.util.make_position_params()) end,
    })
  end, buffer)
end

-- A place that was clicked in the window.
function M.clicked(_, params)
  local buffer = vim.uri_to_bufnr(params.uri)
  vim.fn.bufload(buffer)
  if buffer ~= vim.api.nvim_get_current_buf() then vim.api.nvim_set_current_buf(buffer) end
  local line = vim.fn.getline(params.position.line + 1)
  local column = vim.str_byteindex(line, math.min(params.position.character, vim.str_utfindex(line)))
  vim.api.nvim_win_set_cursor(0, { params.position.line + 1, column })
end

-- Adds so many units of its last digit to the number at or after the cursor.
function M.slide(steps)
  local row, column = unpack(vim.api.nvim_win_get_cursor(0))
  local line, from = vim.api.nvim_get_current_line(), 1
  while true do
    local first, last, number = line:find("(%d+%.?%d*)", from)
    if not first then return end
    if last > column and not line:sub(first - 1, first - 1):find("[%w_#]") then
      local decimals = #(number:match("%.(%d+)$") or "")
      local value = math.max(tonumber(number) + steps * 10 ^ -decimals, 0)
      vim.api.nvim_buf_set_text(0, row - 1, first - 1, row - 1, last, { ("%." .. decimals .. "f"):format(value) })
      return
    end
    from = last + 1
  end
end

local clients = {} -- by root and command, one server for all texts below it

local function attach(buffer, options)
  local file = vim.api.nvim_buf_get_name(buffer)
  local root = options.root_dir or vim.fn.fnamemodify(file, ":p:h")
  local key = root .. "\0" .. table.concat(options.cmd, "\0")
  if not clients[key] or not vim.lsp.get_client_by_id(clients[key]) then
    clients[key] = vim.lsp.start_client({
      name = "fathom",
      cmd = options.cmd,
      root_dir = root,
      workspace_folders = { { uri = vim.uri_from_fname(root), name = root } },
      on_attach = function(client, attached)
        if options.hints ~= false then M.show_hints(attached, client) end
        if options.on_attach then options.on_attach(client, attached) end
      end,
      handlers = vim.tbl_extend("force", { ["fathom/clicked"] = M.clicked }, options.handlers or {}),
    })
  end
  if not clients[key] then return end
  vim.lsp.buf_attach_client(buffer, clients[key])
  local client = vim.lsp.get_client_by_id(clients[key])
  vim.api.nvim_buf_create_user_command(buffer, "FathomShow", function() M.show(buffer, client) end, {})
  vim.keymap.set("n", "<M-Up>", function() M.slide(vim.v.count1) end, { buffer = buffer })
  vim.keymap.set("n", "<M-Down>", function() M.slide(-vim.v.count1) end, { buffer = buffer })
  if options.hints == false then return end
  vim.api.nvim_create_autocmd({ "InsertLeave", "TextChanged", "BufWritePost" }, {
    buffer = buffer,
    callback = function() M.show_hints(buffer, client) end,
  })
end

-- `cmd`: the server; `root_dir`: the folder of the scenes, that of the file unless said; `hints`:
-- false for none; `on_attach`, `handlers`: as for vim.lsp.start_client.
function M.setup(options)
  options = vim.tbl_extend("force", { cmd = { "fathom", "lsp" } }, options or {})
  vim.api.nvim_create_autocmd("FileType", {
    pattern = "fathom",
    callback = function(event) attach(event.buf, options) end,
  })
end

return M
