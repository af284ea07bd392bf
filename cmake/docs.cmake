# SPDX-License-Identifier: BSD-3-Clause
# Target `docs`: reference of the public headers; a warning of Doxygen is an error.
find_program(MPS_DOXYGEN doxygen)
if(MPS_DOXYGEN)
  file(GLOB MPS_PLUGIN_HEADERS CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/plugins/*/include/mps)
  list(JOIN MPS_PLUGIN_HEADERS " " MPS_PLUGIN_HEADERS)
  configure_file(docs/Doxyfile.in Doxyfile @ONLY)
  add_custom_target(docs COMMAND ${MPS_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile VERBATIM COMMENT "Reference in ${PROJECT_BINARY_DIR}/docs/html")
endif()

# Target `site`: all documents, the reference and a gallery of the cases as pages; a warning is an error.
find_program(MPS_SPHINX sphinx-build PATHS /usr/bin NO_DEFAULT_PATH)
if(MPS_DOXYGEN AND MPS_SPHINX)
  if(TARGET mps_program)
    add_custom_target(site COMMAND ${PROJECT_SOURCE_DIR}/scripts/site ${PROJECT_BINARY_DIR} VERBATIM COMMENT "Site in ${PROJECT_BINARY_DIR}/site/html")
    add_dependencies(site mps_program)
  else()
    add_custom_target(site COMMAND ${PROJECT_SOURCE_DIR}/scripts/site ${PROJECT_BINARY_DIR} --no-gallery VERBATIM COMMENT "Site in ${PROJECT_BINARY_DIR}/site/html")
  endif()
endif()
