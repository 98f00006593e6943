#include "simulation/bodies/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <limits>

#include "runtime/error.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

struct NumberedFile {
    long number = 0;
    std::string name;
};

long number_in(const MeshObstacle& obstacle, const std::string& name, std::string_view text) {
    long number = -1;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc() && rest == text.data() + text.size() && text[0] != '-') return number;
    refuse_frames(obstacle,
                  fmt::format("'{}' fits, but '{}' is no number of a frame; another name for it, "
                              "or another pattern",
                              name, text));
}

/// The files that fit, by their numbers.
std::vector<NumberedFile> fitting_files(const MeshObstacle& obstacle, const fs::path& folder) {
    const std::string pattern = fs::path(obstacle.frames).filename().string();
    const std::size_t star = pattern.find('*');
    if (star == std::string::npos) {
        refuse_frames(obstacle,
                      "expected a * where the number of the frame stands, or an HDF5 file (.h5)");
    }
    const std::string begin = pattern.substr(0, star);
    const std::string end = pattern.substr(star + 1);
    std::vector<NumberedFile> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (name.size() <= begin.size() + end.size()) continue;
        if (!name.starts_with(begin) || !name.ends_with(end)) continue;
        const auto text = std::string_view(name).substr(star, name.size() - pattern.size() + 1);
        files.push_back({number_in(obstacle, name, text), name});
    }
    if (files.empty()) refuse_frames(obstacle, "no file has such a name");
    std::ranges::sort(files, {}, &NumberedFile::number);
    return files;
}

void check_that_numbers_differ(const MeshObstacle& obstacle,
                               const std::vector<NumberedFile>& files) {
    const auto twice = std::ranges::adjacent_find(files, {}, &NumberedFile::number);
    if (twice == files.end()) return;
    refuse_frames(obstacle, fmt::format("'{}' and '{}' have the same number", twice->name,
                                        std::next(twice)->name));
}

fs::path folder_of(const MeshObstacle& obstacle) {
    const fs::path pattern(obstacle.frames);
    return pattern.has_parent_path() ? pattern.parent_path() : ".";
}

/// Where a file's name ends that stands in front of ":/path/of/dataset", or alone; npos: it is none
/// of HDF5.
std::size_t end_of_hdf5_name(const std::string& frames) {
    std::string lower = frames;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    constexpr std::array<std::string_view, 3> kEndings{".h5", ".hdf5", ".vtkhdf"};
    for (const std::string_view ending : kEndings) {
        const std::size_t at = lower.find(std::string(ending) + ':');
        if (at != std::string::npos) return at + ending.size();
    }
    const auto ends = [&](std::string_view ending) { return lower.ends_with(ending); };
    if (std::ranges::any_of(kEndings, ends)) return lower.size();
    return std::string::npos;
}

}  // namespace

std::optional<FrameDataset> frame_dataset(const MeshObstacle& obstacle) {
    const std::string& frames = obstacle.frames;
    const std::size_t end = end_of_hdf5_name(frames);
    if (end == std::string::npos) return std::nullopt;
    return FrameDataset{frames.substr(0, end), frames.substr(std::min(end + 1, frames.size()))};
}

void refuse_frames(const MeshObstacle& obstacle, const std::string& why) {
    throw UserError(
        fmt::format("{}: motion.frames = \"{}\": {}", obstacle.where, obstacle.frames, why));
}

std::vector<std::string> frame_files(const MeshObstacle& obstacle) {
    if (obstacle.frames.empty()) return {};
    if (const auto dataset = frame_dataset(obstacle)) return {dataset->file};
    const fs::path folder = folder_of(obstacle);
    const std::vector<NumberedFile> files = fitting_files(obstacle, folder);
    check_that_numbers_differ(obstacle, files);
    std::vector<std::string> paths;
    for (const NumberedFile& file : files) paths.push_back((folder / file.name).string());
    return paths;
}

void warn_of_missing_frames(const MeshObstacle& obstacle, Warnings& warnings) {
    if (obstacle.frames.empty() || frame_dataset(obstacle)) return;
    const std::vector<NumberedFile> files = fitting_files(obstacle, folder_of(obstacle));
    long step = std::numeric_limits<long>::max();
    for (std::size_t i = 1; i < files.size(); ++i) {
        step = std::min(step, files[i].number - files[i - 1].number);
    }
    for (std::size_t i = 1; i < files.size(); ++i) {
        if (files[i].number - files[i - 1].number == step) continue;
        warnings.push_back(fmt::format(
            "{}: motion.frames = \"{}\": number {} is missing between '{}' and '{}', of which one "
            "follows the other as if nothing were",
            obstacle.where, obstacle.frames, files[i - 1].number + step, files[i - 1].name,
            files[i].name));
        return;
    }
}

}  // namespace weft
