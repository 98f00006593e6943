#ifndef OWN_CELL_H
#define OWN_CELL_H

#include <weft/kernel.h>

WEFT_KERNELS_IN(own)

typedef struct {
    float heat, flux;
    int zone;
} Cell;

WEFT_KERNELS_END

#endif
