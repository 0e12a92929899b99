# Run as a script: writes OUTPUT, a C++ file that defines `std::optional<std::string_view> FUNCTION(
# std::string_view name)` of namespace fude: the text of each of FILES (a ;-list) by its file name.
set(text "// Generated from the kernel text.\n#include <optional>\n#include <string_view>\n\nnamespace fude {\n\n")
string(APPEND text "std::optional<std::string_view> ${FUNCTION}(std::string_view name);\n")
string(APPEND text "std::optional<std::string_view> ${FUNCTION}(std::string_view name) {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(READ ${file} body)
  string(APPEND text "  if (name == \"${name}\")\n    return R\"kernel(${body})kernel\";\n")
endforeach()
string(APPEND text "  return std::nullopt;\n}\n\n}  // namespace fude\n")
file(WRITE ${OUTPUT} "${text}")
