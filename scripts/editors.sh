#!/bin/sh
# What the editors make of texts: scripts/editors.sh [FATHOM]. Installs Vim, Neovim, Emacs and npm packages,
# compares each grammar with the compiler's tokens, runs the server in Neovim and in Emacs, and packs VS Code's
# extension into build/editors/.
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd) || exit 3
. "$root/scripts/setup.sh"
install_packages vim neovim emacs-nox elpa-eglot python3 || exit 3
program=${1:-$root/build/fathom}
work=$root/build/editors
mkdir -p "$work/grammars" && cd "$work/grammars" || exit 3
[ -e package.json ] || echo '{"private": true}' >package.json
npm install --no-audit --no-fund --ignore-scripts vscode-textmate@9.0.0 vscode-oniguruma@2.0.1 \
    @lezer/generator@1.5.1 || exit 3
python3 "$root/editors/make.py" "$program" --check || exit 1
python3 "$root/tests/editors/grammars.py" "$program" node_modules || exit 1
rm -rf "$work/neovim" && mkdir "$work/neovim" || exit 3
FATHOM_ROOT=$root FATHOM_PROGRAM=$program FATHOM_WORK=$work/neovim \
    timeout 120 nvim --clean --headless -u "$root/tests/editors/neovim.lua" || exit 1
rm -rf "$work/emacs" && mkdir "$work/emacs" || exit 3
FATHOM_ROOT=$root FATHOM_PROGRAM=$program FATHOM_WORK=$work/emacs \
    timeout 120 emacs --batch -l "$root/tests/editors/emacs.el" || exit 1
node "$root/tests/editors/vscode.mjs" "$root/editors/vscode/extension.js" || exit 1
rm -rf "$work/vscode" && cp -r "$root/editors/vscode" "$work/vscode" && cd "$work/vscode" || exit 3
npm install --no-audit --no-fund --ignore-scripts && npm run build && npm run package
