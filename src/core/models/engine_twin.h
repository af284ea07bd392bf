/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of arrays at two places share. */
#ifndef MPS_CORE_ENGINE_TWIN_H
#define MPS_CORE_ENGINE_TWIN_H

#include "engine.h"

/* Where fields begin in the list of twins. */
enum { MPS__TWIN_FIELDS = MPS__CHANNELS };

/* The twin of a field. Twins follow their fields, which may have been added, dropped or put in
 * another order since. */
mps__twin *mps__twin_of_field(mps__twins *t, int32_t field);
/* Room for `bytes`; what it held is gone. */
mps_status mps__twin_fit(mps__twins *t, mps__twin *twin, size_t bytes, size_t number);
void mps__twin_give_back(mps__twins *t, mps__twin *twin);
/* Make the values at a place the newest ones, if they are not. */
void mps__twin_copy(mps__twins *t, mps__twin *twin, void *host, int32_t place);
/* The values at a place have changed; `all`: all of them. */
void mps__twin_change(mps__twins *t, mps__twin *twin, void *host, int32_t place, bool all);
/* The twin of a channel; NULL: it has none. */
mps__twin *mps__twin_of(mps__twins *t, int32_t channel);

#endif
