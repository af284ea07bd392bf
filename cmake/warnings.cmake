# SPDX-License-Identifier: BSD-3-Clause
# Compiler flags of everything in this project; never passed on to users of the library.
add_library(mps_warnings INTERFACE)
target_compile_options(mps_warnings INTERFACE -Wall -Wextra -pedantic -Wshadow
                       -ffp-contract=off # same input, same bytes, on machines with fused multiply-add too
                       $<$<BOOL:${MPS_WERROR}>:-Werror>)
