# SPDX-License-Identifier: BSD-3-Clause
# Write files as C arrays: cmake -DOUT=file.c "-DFILES=name=path;name=path" -P embed.cmake
# Each becomes `const unsigned char mps__page_<name>[]` and `const size_t mps__page_<name>_size`.
set(text "/* Made by cmake/embed.cmake. */\n#include \"page_assets.h\"\n")
foreach(pair ${FILES})
  string(REGEX MATCH "^([a-z_]+)=(.*)$" pair "${pair}")
  set(name ${CMAKE_MATCH_1})
  file(READ "${CMAKE_MATCH_2}" hex HEX)
  string(LENGTH "${hex}" digits)
  math(EXPR size "${digits} / 2")
  string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," hex "${hex}")
  string(APPEND text "\nconst unsigned char mps__page_${name}[] = {\n${hex}};\nconst size_t mps__page_${name}_size = ${size};\n")
endforeach()
file(WRITE "${OUT}" "${text}")
