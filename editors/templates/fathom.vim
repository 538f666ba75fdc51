" Syntax of Fathom. Written by editors/make.py from `fathom doc --json`; do not change it here.
if exists("b:current_syntax")
  finish
endif
syn case match
syn sync fromstart

syn match fathomName "\<\h\w*\>"
syn match fathomOperator "!=\|[-=|&<>+*/%^]\|\.\.=\|\.\."
syn match fathomNumber "\%(\w\)\@<!\%(\d\+\%(\.\d\+\)\?\|\.\d\+\)\%([eE][+-]\?\d\+\)\?\%(@VIMWORDS(units)@\)\?\w\@!"
syn match fathomColor "#\%(\x\{8}\|\x\{6}\|\x\{3}\)\w\@!"
syn match fathomArgument "\<\h\w*\>\ze\s*:"
syn match fathomCall "\<\h\w*\>\ze("
syn keyword fathomControl @SPACED(control)@
syn keyword fathomDeclaration @SPACED(declaring)@
syn keyword fathomWordOperator and not or
syn keyword fathomTruth @SPACED(truths)@
syn keyword fathomConstant @LINES(constants)@
syn keyword fathomColorName @LINES(colors)@
" a keyword would win over an argument's name, so functions are matched
syn match fathomFunction "\<\%(@VIMWORDS(functions)@\)\>\ze\s*[({]"
syn match fathomType "\%(:\|->\)\s*\[*\zs\%(@VIMWORDS(types)@\)\>\ze\s*\%([(]\)\@!"
syn match fathomControl "\.\@<!\<limit\>\ze\s\+[[:alnum:]_(]"
syn match fathomString "\"\%([^"\\]\|\\.\)*\""
syn match fathomString "\"\%([^"\\]\|\\.\)*\"\ze\s\+as\>" nextgroup=fathomAs skipwhite
syn match fathomAs "\<as\>" contained
syn match fathomComment "//.*$"
syn region fathomComment start="/\*" end="\*/"

hi def link fathomOperator Operator
hi def link fathomNumber Number
hi def link fathomColor Constant
hi def link fathomArgument Identifier
hi def link fathomCall Function
hi def link fathomControl Statement
hi def link fathomAs Statement
hi def link fathomDeclaration Keyword
hi def link fathomWordOperator Keyword
hi def link fathomTruth Boolean
hi def link fathomConstant Constant
hi def link fathomColorName Constant
hi def link fathomFunction Function
hi def link fathomType Type
hi def link fathomString String
hi def link fathomComment Comment

let b:current_syntax = "fathom"
