#!/bin/sh
# The pictures of docs/editors.md: scripts/editor_pictures.sh [FATHOM]. Installs what it needs: Neovim
# in xterm on a display of its own, and VS Code's grammar as a page in Chromium.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages neovim xterm xvfb imagemagick chromium fonts-dejavu-core || exit 3
program=${1:-$root/build/fathom}
work=$root/build/editors/pictures
rm -rf "$work" && mkdir -p "$work" && cd "$work" || exit 3
cat >tower.sdf <<'SCENE'
/// A pillar that narrows towards its top.
fn pillar(height: float, radius = 0.22) -> shape {
  cylinder(radius, height).taper(0.85, axis: Y)
}
param rate = 0.4 in 0..1
let stone = material(diffuse: #c8b89a, exponent: 32)
shpere(0.2).translate(y: 2.8)
for i in 0..8 {
  pillar(2.4).translate(x: 2).rotate(i * turn / 8, axis: Y).paint(stone)
}
box([1, 3, 1]).twist(rate, axis: Y).paint(tomato)
sphere(0.6).displace(p => 0.05 * sin(20 * p.x)).translate(y: 2)
SCENE
[ -e node_modules ] || npm install --no-audit --no-fund --ignore-scripts --prefix . vscode-textmate@9.0.0 \
    vscode-oniguruma@2.0.1 >/dev/null || exit 3
NODE_MODULES=$work/node_modules node "$root/tests/editors/textmate_page.mjs" "$root" tower.sdf >vscode.html || exit 1
chromium --headless --no-sandbox --hide-scrollbars --window-size=760,330 --screenshot=vscode.png \
    "file://$work/vscode.html" 2>/dev/null || exit 1
cat >init.lua <<'LUA'
vim.opt.runtimepath:append(vim.env.FATHOM_ROOT .. "/editors/vim")
vim.opt.runtimepath:append(vim.env.FATHOM_ROOT .. "/editors/neovim")
vim.opt.termguicolors, vim.opt.background, vim.opt.signcolumn = true, "dark", "yes"
vim.cmd("colorscheme slate | filetype plugin indent on | syntax on")
vim.cmd("highlight NormalFloat guifg=#d4d4d4 guibg=#33334a")
require("fathom").setup({ cmd = { vim.env.FATHOM_PROGRAM, "lsp" } })
vim.defer_fn(function()
  vim.fn.search("taper")
  vim.fn.search("pillar")
  vim.lsp.buf.hover()
end, 2500)
LUA
Xvfb :77 -screen 0 980x480x24 -nolisten tcp >/dev/null 2>&1 &
server=$!
sleep 2
FATHOM_ROOT=$root FATHOM_PROGRAM=$program DISPLAY=:77 xterm -fa "DejaVu Sans Mono" -fs 11 -bg "#1e1e1e" -fg "#d4d4d4" \
    -geometry 108x25+0+0 -e nvim --clean -u init.lua tower.sdf &
terminal=$!
sleep 8
DISPLAY=:77 import -window root neovim.png
kill $terminal $server
mkdir -p "$root/docs/editors" && cp vscode.png neovim.png "$root/docs/editors/"
