#include "runtime/launch.h"

#include <algorithm>

#include "scheduler/assert.h"

namespace weft {

int Segments::largest(int colour, int first_strip, int end_strip) const {
    WEFT_ASSERT(0 <= colour && colour < colour_count);
    WEFT_ASSERT(0 <= first_strip && first_strip <= end_strip && end_strip <= strip_count);
    int most = 0;
    for (int strip = first_strip; strip < end_strip; ++strip) {
        WEFT_ASSERT(item(strip, colour) <= item(strip, colour + 1));
        most = std::max(most, item(strip, colour + 1) - item(strip, colour));
    }
    return most;
}

long TaskBody::item_count(int first_strip, int end_strip) const {
    long count = 0;
    for (const Launch& launch : launches) {
        WEFT_ASSERT(end_strip <= launch.segments.strip_count);
        count += launch.segments.item_count(first_strip, end_strip);
    }
    WEFT_ASSERT(count >= 0);
    return count;
}

}  // namespace weft
