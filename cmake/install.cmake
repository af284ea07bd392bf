# SPDX-License-Identifier: BSD-3-Clause
# What `cmake --install` puts where. The static library's targets are a set of their own: only they need SUNDIALS.
include(CMakePackageConfigHelpers)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/mps)

install(TARGETS mps EXPORT mpsTargets)
install(TARGETS mps_static EXPORT mpsStaticTargets)
install(DIRECTORY include/mps TYPE INCLUDE FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")
install(FILES bindings/fortran/mps_types.f90 bindings/fortran/mps_functions.f90 bindings/fortran/mps.f90 DESTINATION ${CMAKE_INSTALL_DATADIR}/mps/fortran)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT mpsTargets NAMESPACE mps:: DESTINATION ${package})
install(EXPORT mpsStaticTargets NAMESPACE mps:: DESTINATION ${package})

# Conformance kits of models and of solvers, as sources: mps::model_kit and mps::solver_kit.
set(MPS_KIT_DIR ${CMAKE_INSTALL_DATADIR}/mps/conformance)
foreach(kit model_kit.h model_kit.c model_scenes.h model_scenes.c model_copies.h model_copies.c model_watch.c model_ranks.c model_report.c solver_kit.h solver_kit.c solver_systems.c solver_ranks.h solver_ranks.c kit_engine.h
    kit_engine.c)
  install(FILES tests/conformance/${kit} DESTINATION ${MPS_KIT_DIR})
endforeach()

configure_package_config_file(cmake/mpsConfig.cmake.in mpsConfig.cmake INSTALL_DESTINATION ${package} PATH_VARS MPS_KIT_DIR)
write_basic_package_version_file(mpsConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/mpsConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/mpsConfigVersion.cmake DESTINATION ${package})

# pkg-config: what the static library needs, as flags.
set(MPS_PC_PRIVATE "")
foreach(target ${MPS_SUNDIALS})
  string(REPLACE "SUNDIALS::" "-lsundials_" flag ${target})
  string(APPEND MPS_PC_PRIVATE "${flag} ")
endforeach()
string(APPEND MPS_PC_PRIVATE "-lklu -pthread -lm")
# from the folder of mps.pc up to the prefix, so that an installed tree may be moved
file(RELATIVE_PATH MPS_PC_PREFIX_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(pkgconfig/mps.pc.in mps.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/mps.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
