" Indentation of Fathom: a step for each bracket that the line above leaves open, and one for a line
" that goes on with `.`, `|` or `&`.
if exists("b:did_indent")
  finish
endif
let b:did_indent = 1
setlocal indentexpr=FathomIndent() indentkeys=0{,0},0),0],0.,0\|,0&,o,O,!^F
let b:undo_indent = "setlocal indentexpr< indentkeys<"

" Brackets that a line opens, less those that it closes, strings and comments left out.
function! s:Open(text)
  let text = substitute(a:text, '"\%([^"\\]\|\\.\)*"\|//.*$', '', 'g')
  return strlen(substitute(text, '[^([{]', '', 'g')) - strlen(substitute(text, '[^)\]}]', '', 'g'))
endfunction

function! FathomIndent()
  let above = prevnonblank(v:lnum - 1)
  if above == 0
    return 0
  endif
  let indent = indent(above)
  let text = getline(above)
  let goes_on = '^\s*[.|&]'
  if getline(v:lnum) =~ goes_on
    return text =~ goes_on ? indent : indent + (s:Open(text) < 0 ? 0 : shiftwidth())
  endif
  if text =~ goes_on
    let indent -= shiftwidth()
  endif
  let closes = text =~ '^\s*[)\]}]'
  let indent += shiftwidth() * (min([s:Open(text) + closes, 1]) > 0 ? 1 : s:Open(text) + closes < 0 ? -1 : 0)
  if getline(v:lnum) =~ '^\s*[)\]}]'
    let indent -= shiftwidth()
  endif
  return max([indent, 0])
endfunction
