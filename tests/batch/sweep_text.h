#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "runtime/error.h"

namespace weft::batch {

/// A folder of its own for a test, empty, and the place that the test runs in.
class InFolder : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("weft_batch_") + test->test_suite_name() + "_" + test->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }

    std::filesystem::path folder_;
};

/// The message of the UserError that `work` throws.
template <class Work>
std::string message_of(const Work& work) {
    try {
        work();
    } catch (const UserError& error) {
        return error.what();
    }
    return "nothing was refused";
}

inline const char* const kScene = R"(
[scene]
frames = 3
dt = 0.02
substeps = 2
[solver]
method = "xpbd"
iterations = 2
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [6, 6] }
density = 0.2
stretch = { stiffness = 1.0e4 }
)";

inline const std::string kHead = "sweep = { name = \"s\", scene = \"scene.toml\" }\n";

}  // namespace weft::batch
