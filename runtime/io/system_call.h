#pragma once

#include <cerrno>

namespace weft {

/// A system call, made again where a signal came in between. call: returns what the system does,
/// negative where it failed, and errno says why.
template <class Call>
auto until_uninterrupted(Call call) {
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

}  // namespace weft
