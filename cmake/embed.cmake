# Writes a C++ file that holds the texts of others, for the program needs none at run time:
#   cmake -DOUT=… -DNAMESPACE=… -DFUNCTION=… "-DFILES=a;b" -P embed.cmake
# makes `const std::vector<std::pair<std::string_view, std::string_view>> &FUNCTION()`: (file name, text), in order.
set(text "// Made by cmake/embed.cmake from the files that it names.\n#include <string_view>\n#include <utility>\n#include <vector>\n\nnamespace ${NAMESPACE} {\n\n")
string(APPEND text "const std::vector<std::pair<std::string_view, std::string_view>> &${FUNCTION}() {\n")
string(APPEND text "    using namespace std::string_view_literals;\n")
string(APPEND text "    static const std::vector<std::pair<std::string_view, std::string_view>> files{\n")
separate_arguments(FILES)
foreach(path IN LISTS FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} content)
  string(APPEND text "        {\"${name}\"sv, R\"fathom~(${content})fathom~\"sv},\n")
endforeach()
string(APPEND text "    };\n    return files;\n}\n\n} // namespace ${NAMESPACE}\n")
file(WRITE ${OUT} "${text}")
