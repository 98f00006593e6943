#include "runtime/planning/division.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "scheduler/assert.h"

namespace weft {

Division Division::single(int device_count, int strip_count, int device) {
    WEFT_ASSERT(device >= 0 && device < device_count);
    Division division{std::vector<int>(static_cast<std::size_t>(device_count), 0)};
    division.strips[static_cast<std::size_t>(device)] = strip_count;
    return division;
}

Division Division::proportional(int strip_count, std::span<const double> speeds) {
    const double all = std::accumulate(speeds.begin(), speeds.end(), 0.0);
    WEFT_ASSERT(all > 0.0);
    Division division;
    double before = 0.0;
    int given = 0;
    for (std::size_t d = 0; d < speeds.size(); ++d) {
        before += speeds[d];
        const int later = static_cast<int>(speeds.size() - d) - 1;  // devices that still want one
        int end = static_cast<int>(std::lround(before / all * strip_count));
        end = std::max(std::min(end, strip_count - later), std::min(given + 1, strip_count));
        WEFT_ASSERT(end >= given);
        division.strips.push_back(end - given);
        given = end;
    }
    WEFT_ASSERT(given == strip_count);
    return division;
}

std::vector<int> Division::devices() const {
    std::vector<int> list;
    for (std::size_t d = 0; d < strips.size(); ++d) {
        if (strips[d] > 0) list.push_back(static_cast<int>(d));
    }
    return list;
}

Partition Division::partition() const {
    Partition partition;
    int begin = 0;
    for (const int device : devices()) {
        const int end = begin + strips[static_cast<std::size_t>(device)];
        partition.parts.push_back({begin, end});
        begin = end;
    }
    return partition;
}

unsigned Division::mask() const {
    unsigned mask = 0;
    for (const int device : devices()) mask |= 1U << device;
    return mask;
}

int Division::distance(const Division& other) const {
    int most = 0;
    for (std::size_t d = 0; d < strips.size(); ++d) {
        most = std::max(most, std::abs(strips[d] - other.strips[d]));
    }
    return most;
}

std::vector<Division> Division::neighbours(std::span<const int> among) const {
    std::vector<Division> list;
    for (std::size_t i = 0; i + 1 < among.size(); ++i) {
        const auto d = static_cast<std::size_t>(among[i]);
        const auto next = static_cast<std::size_t>(among[i + 1]);
        for (const int moved : {-1, 1}) {
            Division other = *this;
            other.strips[d] += moved;
            other.strips[next] -= moved;
            if (other.strips[d] >= 0 && other.strips[next] >= 0) list.push_back(std::move(other));
        }
    }
    return list;
}

}  // namespace weft
