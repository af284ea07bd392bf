# SPDX-License-Identifier: BSD-3-Clause
# Sourced by demo, check and validate: find out which Debian packages are missing, say so, install them.

BUILD_PACKAGES=(gcc libc6-dev make cmake libsundials-dev libsuitesparse-dev libcairo2-dev zlib1g-dev libyaml-dev pkg-config)
QUICK_PACKAGES=("${BUILD_PACKAGES[@]}" g++ libcmocka-dev locales python3)
CHECK_PACKAGES=("${QUICK_PACKAGES[@]}" gfortran clang clang-format clang-tidy cppcheck doxygen binutils
    libopenmpi-dev openmpi-bin libtrilinos-zoltan-dev python3-numpy python3-jsonschema python3-yaml scdoc man-db llvm pocl-opencl-icd ocl-icd-opencl-dev)
VALIDATE_PACKAGES=(python3 python3-numpy python3-matplotlib python3-pil)

missing_packages() {
    local package
    for package in "$@"; do
        dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || echo "$package"
    done
}

# need_packages install|no-install PACKAGE...
need_packages() {
    local mode=$1 missing sudo=()
    shift
    if ! command -v dpkg-query >/dev/null; then
        echo "This is not Debian or Ubuntu; please make sure that their equivalents of these are there: $*"
        return
    fi
    mapfile -t missing < <(missing_packages "$@")
    [ "${#missing[@]}" -gt 0 ] || return 0
    if [ "$mode" = no-install ]; then
        echo "Missing packages (--no-install: not installing them): ${missing[*]}"
        return
    fi
    [ "$(id -u)" = 0 ] || sudo=(sudo)
    # an installation that was cut short stops every later one until it is finished; else this does nothing
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive dpkg --configure -a
    echo "Installing with ${sudo[*]:+sudo }apt-get: ${missing[*]}"
    "${sudo[@]}" apt-get update -qq
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}
