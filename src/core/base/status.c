/* SPDX-License-Identifier: BSD-3-Clause */
/* Names and meanings of the status codes; the version. */
#include <mps/status.h>
#include <mps/version.h>

const char *mps_status_name(mps_status status)
{
    switch (status) {
#define MPS__NAME(name, value, meaning) \
    case value:                         \
        return #name;
        MPS_STATUS_LIST(MPS__NAME)
#undef MPS__NAME
    default:
        return "MPS_E_UNKNOWN";
    }
}

const char *mps_status_text(mps_status status)
{
    switch (status) {
#define MPS__TEXT(name, value, meaning) \
    case value:                         \
        return meaning;
        MPS_STATUS_LIST(MPS__TEXT)
#undef MPS__TEXT
    default:
        return "unknown status";
    }
}

const char *mps_version(int *major, int *minor, int *patch)
{
    if (major) *major = MPS_VERSION_MAJOR;
    if (minor) *minor = MPS_VERSION_MINOR;
    if (patch) *patch = MPS_VERSION_PATCH;
    return MPS_VERSION_STRING;
}
