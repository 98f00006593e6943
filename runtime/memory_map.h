#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "runtime/device.h"
#include "runtime/step.h"

namespace weft {

/// A stretch of a buffer in the units of its accesses.
struct Interval {
    int begin = 0;
    int end = 0;
};

/// A memory that devices work in: the host's, or a device's own. A type, since these numbers meet
/// those of devices.
class MemoryId {
public:
    static constexpr MemoryId host() { return MemoryId(0); }
    /// That of a device that does not work in the host's; device: its number in the executor
    static constexpr MemoryId of_device(int device) { return MemoryId(device + 1); }

    constexpr bool is_host() const { return number_ == 0; }
    /// Not of the host's.
    constexpr int device() const { return number_ - 1; }
    /// The host's is the least.
    friend constexpr auto operator<=>(const MemoryId&, const MemoryId&) = default;

private:
    explicit constexpr MemoryId(int number) : number_(number) {}
    int number_;
};

/// Which of the memories holds the current data of which part of which buffer (as caches do:
/// modified, shared, invalid). What is not noted is current everywhere.
class MemoryMap {
public:
    /// A stretch that has to be copied, and the work that made its data.
    struct Missing {
        Interval interval;
        MemoryId source = MemoryId::host();
        std::vector<Completion*> made_by;  ///< different ones; none: long done
    };

    /// What of an access is not current in `memory`, in as few stretches as their sources allow:
    /// what a copy takes is mostly that there is one. Both reads and updates read.
    std::vector<Missing> missing(const Access& access, MemoryId memory) const;
    /// Copies into `memory`, perhaps still under way, that brought parts of the access.
    std::vector<Completion*> arrivals(const Access& access, MemoryId memory) const;
    /// The data of the missing part are in `memory` as well once `arrival` is done.
    void arrived(const Access& access, Interval interval, MemoryId memory, Completion* arrival);
    /// A task on `memory` writes this: it is current there alone.
    void written(const Access& access, MemoryId memory, Completion* task);
    /// The buffer is current everywhere again.
    void forget(const BufferStorage& buffer);
    /// Forgets completions: everything that was under way is done.
    void settle();

    /// Everything of the buffer that is not current in the host's memory, each with its access.
    std::vector<std::pair<Access, Missing>> missing_at_host(const BufferStorage& buffer) const;

private:
    struct Holder {
        MemoryId memory = MemoryId::host();
        Completion* since = nullptr;  ///< null: long ago
        bool copied = false;          ///< brought there, not made there
    };
    struct Part {
        Interval interval;
        std::vector<Holder> holders;  ///< where it is current
    };
    using Key = std::pair<BufferStorage*, int>;  ///< buffer and the start of its segments, or -1
    struct Entry {
        const Segments* segments = nullptr;
        std::vector<Part> parts;  ///< disjoint, ascending
    };

    static void add(std::vector<Missing>& list, Interval interval, const Holder& source);
    static bool is_held(const Part& part, MemoryId memory);
    static bool are_disjoint_and_ascending(const std::vector<Part>& parts);
    static Key key_of(const Access& access);
    /// Cuts parts at the ends of the interval, so that it is made of whole parts.
    static void cut(std::vector<Part>& parts, Interval interval);

    std::map<Key, Entry> entries_;
};

/// The elements of a part of an access, for copying.
ElementSpan elements_of(const Access& access, Interval interval);

}  // namespace weft
