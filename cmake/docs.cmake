# SPDX-License-Identifier: BSD-3-Clause
# Target `docs`: reference of the public headers; a warning of Doxygen is an error.
find_program(MPS_DOXYGEN doxygen)
if(MPS_DOXYGEN)
  configure_file(docs/Doxyfile.in Doxyfile @ONLY)
  add_custom_target(docs COMMAND ${MPS_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile VERBATIM COMMENT "Reference in ${PROJECT_BINARY_DIR}/docs/html")
endif()
