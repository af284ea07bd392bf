/* SPDX-License-Identifier: BSD-3-Clause */
/* Common to the files of mirrored arrays. */
#ifndef MPS_CORE_ENGINE_TWIN_H
#define MPS_CORE_ENGINE_TWIN_H

#include "engine.h"

/* Index of the first field in the list of mirrors. */
enum { MPS__TWIN_FIELDS = MPS__CHANNELS };

/* Mirror of a field. Mirrors follow their fields, which may have been added, dropped or reordered
 * since. */
mps__twin *mps__twin_of_field(mps__twins *t, int32_t field);
/* Resize the buffer to `bytes`; its values are lost. */
mps_status mps__twin_fit(mps__twins *t, mps__twin *twin, size_t bytes, size_t number);
void mps__twin_give_back(mps__twins *t, mps__twin *twin);
/* Make the values in a memory space valid, if they are stale. */
void mps__twin_copy(mps__twins *t, mps__twin *twin, void *host, int32_t place);
/* Values in a memory space changed; `all`: all of them. */
void mps__twin_change(mps__twins *t, mps__twin *twin, void *host, int32_t place, bool all);
/* Mirror of a channel, or NULL. */
mps__twin *mps__twin_of(mps__twins *t, int32_t channel);

#endif
