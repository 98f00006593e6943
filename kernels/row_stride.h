#ifndef WEFT_KERNELS_ROW_STRIDE_H
#define WEFT_KERNELS_ROW_STRIDE_H

/// Rows of entries that kernels fill (runtime/row_table.h) lie in slices of so many items: entry k
/// of an item stands at start + WEFT_ROW_STRIDE * k, and that of the next item beside it. As many
/// as packs of narrow kernels have lanes: what goes along rows whose lengths differ is one.
#define WEFT_ROW_STRIDE 8

#endif
