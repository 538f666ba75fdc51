# Makes the script of a page, and its fingerprint, for the page's policy to name:
#   cmake -DOUT=… -DHASH=… "-DFILES=a;b" -P page.cmake
# OUT is the files, one after the other, without indentation and whole lines of remarks; HASH its SHA-256 in hexadecimal.
separate_arguments(FILES)
set(text "")
foreach(path IN LISTS FILES)
  file(READ ${path} content)
  string(APPEND text "\n${content}")
endforeach()
string(REGEX REPLACE "\n +" "\n" text "${text}")
string(REGEX REPLACE "\n//[^\n]*" "" text "${text}")
string(REGEX REPLACE "\n\n+" "\n" text "${text}")
file(WRITE ${OUT} "${text}")
file(SHA256 ${OUT} hash)
file(WRITE ${HASH} "${hash}\n")
