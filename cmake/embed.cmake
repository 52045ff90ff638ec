# Writes HEADER: the text of FILES as an array NAME of {file name, text}.
foreach(file IN LISTS FILES)
  cmake_path(GET file FILENAME filename)
  file(READ ${file} text)
  string(APPEND entries "    {\"${filename}\", R\"embedded(${text})embedded\"sv},\n")
endforeach()
file(WRITE ${HEADER} "#pragma once
#include <string_view>
#include <utility>

namespace slideway::embedded {
using namespace std::string_view_literals;
inline constexpr std::pair<std::string_view, std::string_view> ${NAME}[] = {
${entries}};
}  // namespace slideway::embedded
")
