autocmd BufRead,BufNewFile *.fdc setfiletype fdc
