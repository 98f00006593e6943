#include "simulation/bodies/dataset_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <vector>

#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "runtime/near_miss.h"

namespace weft {
namespace {

struct Candidate {
    std::string path;
    hdf5::Handle dataset;
    std::vector<hsize_t> shape;
    H5T_class_t type = H5T_NO_CLASS;
};

std::string words(H5T_class_t type) {
    switch (type) {
        case H5T_FLOAT:
            return "floats";
        case H5T_INTEGER:
            return "integers";
        case H5T_STRING:
            return "texts";
        default:
            return "no numbers";
    }
}

std::string words(const Candidate& c) {
    return fmt::format("'{}' ({}) of {}", c.path, fmt::join(c.shape, ", "), words(c.type));
}

/// A file may have thousands.
std::string listed(const std::vector<std::string>& all) {
    constexpr std::size_t kMost = 8;
    if (all.size() <= kMost) return fmt::format("{}", fmt::join(all, ", "));
    return fmt::format("{} and {} more", fmt::join(all.begin(), all.begin() + kMost, ", "),
                       all.size() - kMost);
}

Candidate candidate(std::string path, hdf5::Handle dataset) {
    const hdf5::Handle type(H5Dget_type(dataset.id()), H5Tclose, "read a dataset's type");
    std::vector<hsize_t> shape = hdf5::shape_of(dataset.id());
    return {std::move(path), std::move(dataset), std::move(shape), H5Tget_class(type.id())};
}

class Choice {
public:
    Choice(const MeshObstacle& obstacle, const FrameDataset& source, const hdf5::Handle& file,
           std::size_t vertex_count)
        : obstacle_(obstacle), source_(source), file_(file), vertex_count_(vertex_count) {}

    Candidate named() const {
        Candidate found = candidate(source_.path, open(source_.path));
        if (!fits(found)) refuse(fmt::format("{}; expected {}", words(found), expected()));
        return found;
    }

    Candidate only() const {
        std::vector<std::string> all, paths;
        std::vector<Candidate> fitting;
        for (const std::string& path : hdf5::dataset_paths(file_.id())) {
            Candidate found = candidate(path, open(path));
            all.push_back(words(found));
            if (!fits(found)) continue;
            paths.push_back(fmt::format("'{}'", path));
            fitting.push_back(std::move(found));
        }
        if (all.empty()) refuse("the file has no dataset; expected " + expected());
        if (fitting.empty()) {
            refuse(fmt::format("the file has {}; expected {}", listed(all), expected()));
        }
        if (fitting.size() > 1) {
            const std::string name = std::filesystem::path(source_.file).filename().string();
            refuse(fmt::format("the file has several that fit: {}; say which, as in \"{}:{}\"",
                               listed(paths), name, fitting.front().path));
        }
        return std::move(fitting.front());
    }

private:
    [[noreturn]] void refuse(const std::string& why) const { refuse_frames(obstacle_, why); }

    hdf5::Handle open(const std::string& path) const {
        try {
            return hdf5::open_dataset(file_.id(), path);
        } catch (const hdf5::Error&) {
            const auto known = hdf5::dataset_paths(file_.id());
            const std::string near = near_miss(path, known);
            refuse(fmt::format("the file has no dataset '{}'; {}", path,
                               near.empty() ? "it has " + listed(known) : near));
        }
    }

    bool fits(const Candidate& c) const {
        return c.type == H5T_FLOAT && c.shape.size() == 3 && c.shape[1] == vertex_count_ &&
               c.shape[2] == 3;
    }

    std::string expected() const {
        return fmt::format("(frames, {}, 3) of floats, as obstacle '{}' has {} vertices",
                           vertex_count_, obstacle_.name, vertex_count_);
    }

    const MeshObstacle& obstacle_;
    const FrameDataset& source_;
    const hdf5::Handle& file_;
    std::size_t vertex_count_;
};

/// The library would name the folder in which it looked for one.
void check_filters(const MeshObstacle& obstacle, const Candidate& found) {
    const hdf5::Handle creation(H5Dget_create_plist(found.dataset.id()), H5Pclose,
                                "read a dataset's layout");
    const int count = H5Pget_nfilters(creation.id());
    for (int i = 0; i < count; ++i) {
        char name[64] = "";
        std::size_t no_values = 0;
        const H5Z_filter_t filter =
            H5Pget_filter2(creation.id(), static_cast<unsigned>(i), nullptr, &no_values, nullptr,
                           sizeof(name), name, nullptr);
        if (H5Zfilter_avail(filter) > 0) continue;
        refuse_frames(obstacle, fmt::format("'{}' is packed by the filter '{}' ({}), which is not "
                                            "installed here; gzip and shuffle are",
                                            found.path, name, filter));
    }
}

/// A replay compares the file's bytes, and values that were never written are read as zeros.
void check_kept(const MeshObstacle& obstacle, const Candidate& found, const hdf5::Handle& file) {
    if (hdf5::is_kept_elsewhere(found.dataset.id(), file.id())) {
        refuse_frames(obstacle, fmt::format("'{}' takes its values from other datasets or files, "
                                            "whose changes a replay would not see; copy them",
                                            found.path));
    }
    check_filters(obstacle, found);
    if (H5Dget_storage_size(found.dataset.id()) > 0) return;
    refuse_frames(obstacle, words(found) + " has no values: nobody has written them");
}

}  // namespace

hdf5::Handle open_points(const MeshObstacle& obstacle, const hdf5::Handle& file,
                         const std::string& path) {
    Candidate found = candidate(path, hdf5::open_dataset(file.id(), path));
    if (found.type != H5T_FLOAT || found.shape.size() != 2 || found.shape[1] != 3) {
        refuse_frames(obstacle, words(found) + "; expected (points, 3) of floats");
    }
    check_kept(obstacle, found, file);
    return std::move(found.dataset);
}

ChosenDataset choose_dataset(const MeshObstacle& obstacle, const FrameDataset& source,
                             const hdf5::Handle& file, std::size_t vertex_count) {
    const Choice choice(obstacle, source, file, vertex_count);
    Candidate found = source.path.empty() ? choice.only() : choice.named();
    if (found.shape[0] == 0) refuse_frames(obstacle, words(found) + " has no frame");
    check_kept(obstacle, found, file);
    return {std::move(found.path), std::move(found.dataset), found.shape[0]};
}

}  // namespace weft
