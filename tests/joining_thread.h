#pragma once

#include <thread>
#include <utility>

namespace weft::test {

/// A thread that is waited for where it ends. std::jthread is one, but Apple's libc++ lacks it.
class JoiningThread {
public:
    JoiningThread() = default;
    template <class Call>
    explicit JoiningThread(Call call) : thread_(std::move(call)) {}
    JoiningThread(JoiningThread&&) = default;
    /// Not over one that still runs.
    JoiningThread& operator=(JoiningThread&&) = default;
    ~JoiningThread() {
        if (joinable()) join();
    }

    bool joinable() const { return thread_.joinable(); }
    void join() { thread_.join(); }

private:
    std::thread thread_;
};

}  // namespace weft::test
