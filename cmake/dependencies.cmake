# SPDX-License-Identifier: BSD-3-Clause
# What the library stands on: SUNDIALS (Krylov and sparse direct solvers) and the system's threads.

# 6.4 and 7.x both serve; the package's own version file would refuse the one that was not asked for.
set(components kinsol nvecserial sunlinsolpcg sunlinsolspbcgs sunlinsolspgmr sunlinsolklu sunmatrixsparse)
find_package(SUNDIALS REQUIRED COMPONENTS ${components})
if(SUNDIALS_VERSION VERSION_LESS 6.4)
  message(FATAL_ERROR "SUNDIALS ${SUNDIALS_VERSION} is too old, 6.4 or newer is needed")
endif()
list(TRANSFORM components PREPEND SUNDIALS:: OUTPUT_VARIABLE MPS_SUNDIALS)
if(TARGET SUNDIALS::core) # from 7.0 on
  list(APPEND MPS_SUNDIALS SUNDIALS::core)
endif()

set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)
