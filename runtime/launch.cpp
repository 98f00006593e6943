#include "runtime/launch.h"

#include <algorithm>

namespace weft {

int Segments::largest(int colour, int first_strip, int end_strip) const {
    int most = 0;
    for (int strip = first_strip; strip < end_strip; ++strip) {
        most = std::max(most, item(strip, colour + 1) - item(strip, colour));
    }
    return most;
}

long TaskBody::item_count(int first_strip, int end_strip) const {
    long count = 0;
    for (const Launch& launch : launches)
        count += launch.segments.item_count(first_strip, end_strip);
    return count;
}

}  // namespace weft
