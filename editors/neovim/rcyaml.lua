-- rcyaml in Neovim 0.7 or later: copy this file to ~/.config/nvim/plugin/rcyaml.lua.
-- To set a program or a folder of imports: vim.g.rcyaml_command = { "/path/to/rcyaml", "lsp", "-I", "/path" }

local function command()
  return vim.g.rcyaml_command or { "rcyaml", "lsp" }
end

if vim.lsp.config then -- Neovim 0.11
  vim.lsp.config("rcyaml", { cmd = command(), filetypes = { "yaml" }, root_markers = { "rcyaml.yaml", ".git" } })
  vim.lsp.enable("rcyaml")
  return
end

local clients = {} -- by the folder of the workspace
local has_told = false

local function root_of(path)
  local folder = vim.fn.fnamemodify(path, ":p:h")
  local found = vim.fn.findfile("rcyaml.yaml", vim.fn.escape(folder, " ;,*") .. ";")
  return found ~= "" and vim.fn.fnamemodify(found, ":p:h") or folder
end

local function attach(event)
  local path = vim.api.nvim_buf_get_name(event.buf)
  if path == "" or vim.bo[event.buf].buftype ~= "" then
    return
  end
  local program = command()[1]
  if vim.fn.executable(program) == 0 then
    if not has_told then
      vim.notify(program .. " is not found: pip install 'rcyaml[lsp]'", vim.log.levels.WARN)
    end
    has_told = true
    return
  end
  local root = root_of(path)
  if not clients[root] then
    clients[root] = vim.lsp.start_client({
      name = "rcyaml",
      cmd = command(),
      root_dir = root,
      workspace_folders = { { uri = vim.uri_from_fname(root), name = vim.fn.fnamemodify(root, ":t") } },
      on_exit = function()
        clients[root] = nil
      end,
    })
  end
  if clients[root] then
    vim.lsp.buf_attach_client(event.buf, clients[root])
    vim.bo[event.buf].omnifunc = "v:lua.vim.lsp.omnifunc"
  end
end

vim.api.nvim_create_autocmd("FileType", { pattern = "yaml", callback = attach })
