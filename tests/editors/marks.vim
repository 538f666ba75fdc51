" What Vim's syntax makes of each character (grammars.py), in batch mode: vim -es -S marks.vim FILE…
exe 'set runtimepath^=' . fnameescape(g:root . '/editors/vim')
syntax on
let s:classes = {'Comment': 'c', 'String': 's', 'Number': 'n', 'Color': 'n', 'Operator': 'o',
      \ 'Control': 'k', 'As': 'k', 'Declaration': 'k', 'WordOperator': 'k', 'Truth': 'k'}
for s:file in argv()
  exe 'edit ' . fnameescape(s:file)
  set syntax=fathom
  let s:lines = []
  for s:line in range(1, line('$'))
    let s:marks = ''
    for s:column in range(1, col([s:line, '$']) - 1)
      let s:name = matchstr(synIDattr(synID(s:line, s:column, 0), 'name'), 'fathom\zs.*')
      let s:marks .= get(s:classes, s:name, '.')
    endfor
    call add(s:lines, s:marks)
  endfor
  call writefile([join(s:lines, '.') . (&endofline ? '.' : '')], s:file . '.marks', 'b')
endfor
qall!
