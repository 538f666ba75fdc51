" Settings of Fathom's texts: comments, two blanks a step, `fathom check` as :make, `fathom fmt` as gq.
if exists("b:did_ftplugin")
  finish
endif
let b:did_ftplugin = 1
setlocal commentstring=//\ %s comments=:///,://
setlocal expandtab shiftwidth=2 softtabstop=2
setlocal formatoptions-=t formatoptions+=croql
setlocal makeprg=fathom\ check\ %:S
setlocal errorformat=%f:%l:%c:\ %trror[%.%#]:\ %m,%f:%l:%c:\ %tarning[%.%#]:\ %m,%f:%l:%c:\ %tote[%.%#]:\ %m
setlocal errorformat+=%-G%.%#
if executable("fathom")
  setlocal formatprg=fathom\ fmt\ -
endif
let b:undo_ftplugin = "setlocal commentstring< comments< expandtab< shiftwidth< softtabstop<"
      \ . " formatoptions< makeprg< errorformat< formatprg<"
