#ifndef WEFT_KERNELS_CONTACT_CODES_H
#define WEFT_KERNELS_CONTACT_CODES_H

// What an entry of a body's row (pushes.h) says of the body on the other side: which one it is, and
// on how many levels the two are in one group (groups.h).

#include "kernels/lanes.h"

/// Of a code, so many bits are for a number of levels; those above are for the body.
#define WEFT_LEVEL_BITS 3
/// Bodies that touch are in groups, and these in parts of parts, on so many levels at the most.
#define WEFT_MOST_GROUP_LEVELS ((1 << WEFT_LEVEL_BITS) - 1)

WEFT_KERNELS_BEGIN

WEFT_INLINE whole body_of_code(whole code) { return code >> splat_whole(WEFT_LEVEL_BITS); }

/// Of a body, with no level yet; one more is one more level.
WEFT_INLINE whole code_of_body(whole body) { return body << splat_whole(WEFT_LEVEL_BITS); }

WEFT_KERNELS_END

#endif
