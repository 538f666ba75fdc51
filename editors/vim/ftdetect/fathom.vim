autocmd BufRead,BufNewFile *.sdf setfiletype fathom
