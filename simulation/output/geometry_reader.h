#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

namespace weft {

/// Reads back what GeometryWriter has written; also of a run that was killed. Throws UserError if
/// the file cannot be read.
class GeometryReader {
public:
    explicit GeometryReader(const std::filesystem::path& path);
    ~GeometryReader();

    std::size_t steps() const;
    double time(std::size_t step) const;
    /// [3 * vertices] x y z of each vertex [m]
    std::vector<float> positions(std::size_t step) const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace weft
