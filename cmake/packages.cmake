# SPDX-License-Identifier: BSD-3-Clause
# Packages of Debian, one for each component; scripts/deb builds and tests them.
# They are not called libmps-dev: that is MPSolve, another library with a libmps.so and an <mps/mps.h>.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "libmps <libmps@localhost>")
set(CPACK_COMPONENTS_ALL runtime dev)
if(MPS_BUILD_EXAMPLES)
  list(APPEND CPACK_COMPONENTS_ALL drivers)
endif()
foreach(plugin mpi hypre)
  if(TARGET mps_${plugin})
    list(APPEND CPACK_COMPONENTS_ALL ${plugin})
  endif()
endforeach()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# drivers and plug-ins need libraries that no installed package has yet
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR} ${PROJECT_BINARY_DIR}/plugins/mpi)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON) # of the same version

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME libmps${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "${PROJECT_DESCRIPTION}: shared library")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libmps${PROJECT_VERSION_MAJOR}-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_CONFLICTS libmps-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "libsundials-dev, libsuitesparse-dev") # programs that link the static library
set(CPACK_COMPONENT_DEV_DEPENDS runtime)
set(CPACK_COMPONENT_DEV_DESCRIPTION "${PROJECT_DESCRIPTION}: headers, static library, conformance kits")

set(CPACK_DEBIAN_DRIVERS_PACKAGE_NAME libmps${PROJECT_VERSION_MAJOR}-drivers)
set(CPACK_DEBIAN_DRIVERS_PACKAGE_SECTION science)
set(CPACK_COMPONENT_DRIVERS_DEPENDS runtime)
set(CPACK_DEBIAN_DRIVERS_PACKAGE_SUGGESTS "libmps${PROJECT_VERSION_MAJOR}-mpi")
set(CPACK_COMPONENT_DRIVERS_DESCRIPTION "${PROJECT_DESCRIPTION}: programs of the cases, mps_sloshing_surge and others")

# Plug-in libraries, each with its headers, which need those of libmps.
set(CPACK_COMPONENT_MPI_DESCRIPTION "${PROJECT_DESCRIPTION}: one simulation on many ranks of MPI, also for the drivers")
set(CPACK_COMPONENT_HYPRE_DESCRIPTION "${PROJECT_DESCRIPTION}: pressure solver hypre.boomeramg")
foreach(plugin mpi hypre)
  string(TOUPPER ${plugin} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME libmps${PROJECT_VERSION_MAJOR}-${plugin})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_${upper}_PACKAGE_GENERATE_SHLIBS ON)
  set(CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS "libmps${PROJECT_VERSION_MAJOR}-dev")
  set(CPACK_COMPONENT_${upper}_DEPENDS runtime)
endforeach()
set(CPACK_DEBIAN_MPI_PACKAGE_SUGGESTS "libmps${PROJECT_VERSION_MAJOR}-drivers, openmpi-bin, libopenmpi-dev")
include(CPack)
