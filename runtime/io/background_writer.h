#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace weft {

/// Writes items in order on a thread of its own, so that the frame loop does not wait for a disk.
///
/// One item is under way at a time: when `push` returns, the item before is written. So a killed
/// process loses no more than the last one, and a slow disk costs time, not memory. The first
/// exception of `write` ends the writing: from then on `push` and `drain` rethrow it.
template <class Item>
class BackgroundWriter {
public:
    explicit BackgroundWriter(std::function<void(Item&)> write)
        : write_(std::move(write)), thread_([this] { work(); }) {}

    /// Writes what was pushed; an error that nobody asked for is lost with it.
    ~BackgroundWriter() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }

    BackgroundWriter(const BackgroundWriter&) = delete;
    BackgroundWriter& operator=(const BackgroundWriter&) = delete;

    void push(Item item) {
        std::unique_lock lock(mutex_);
        wait_until_written(lock);
        item_ = std::move(item);
        changed_.notify_all();
    }

    /// Returns when everything pushed so far is written.
    void drain() {
        std::unique_lock lock(mutex_);
        wait_until_written(lock);
    }

private:
    void wait_until_written(std::unique_lock<std::mutex>& lock) {
        changed_.wait(lock, [this] { return !item_ || error_; });
        if (error_) std::rethrow_exception(error_);
    }

    void work() {
        std::unique_lock lock(mutex_);
        while (!error_) {
            changed_.wait(lock, [this] { return item_ || stopping_; });
            if (!item_) return;
            write_item(lock);
            changed_.notify_all();
        }
    }

    /// Called with the lock held; gives it up while the item is written. Nobody touches the item
    /// meanwhile: the others wait until it is gone.
    void write_item(std::unique_lock<std::mutex>& lock) {
        std::exception_ptr error;
        lock.unlock();
        try {
            write_(*item_);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        item_.reset();
        error_ = error;
    }

    const std::function<void(Item&)> write_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<Item> item_;  // under way
    bool stopping_ = false;
    std::exception_ptr error_;
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace weft
