/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of src/post/page as arrays; the build generates their source. */
#ifndef MPS_POST_PAGE_ASSETS_H
#define MPS_POST_PAGE_ASSETS_H

#include <stddef.h>

#define PAGE_ASSETS(X) \
    X(style) X(plot_style) X(plot) X(plot_licence) X(decode) X(curves_js) X(view) X(main)

#define PAGE_ASSET_DECLARE(name)                   \
    extern const unsigned char mps__page_##name[]; \
    extern const size_t mps__page_##name##_size;
PAGE_ASSETS(PAGE_ASSET_DECLARE)
#undef PAGE_ASSET_DECLARE

#endif
