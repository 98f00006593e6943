#pragma once

#include <vector>

#include "runtime/buffer.h"

namespace weft {

/// Gives the system back what a large buffer takes, until somebody writes into it again. What was
/// in it is lost: zeros, or what was there. For buffers that only the host and devices in its
/// memory have, between runs of their executors.
void give_back(BufferStorage& buffer);

/// Frees what a list takes; `list = {}` only empties it.
template <class Value>
void give_back(std::vector<Value>& list) {
    std::vector<Value>().swap(list);
}

/// Once, as a program begins: large lists go back to the system where they are freed. By default
/// glibc keeps more and more of them, the larger those were that it has seen.
void give_back_large_lists();

/// Gives the system back what freed objects leave in the heap. After much was set up: large
/// temporary lists, of which allocators keep the memory for more of the same.
void give_back_freed();

}  // namespace weft
