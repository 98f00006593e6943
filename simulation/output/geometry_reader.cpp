#include "simulation/output/geometry_reader.h"

#include <algorithm>
#include <string>

#include "runtime/error.h"
#include "runtime/io/hdf5.h"

namespace weft {

namespace {

/// Rows [begin, begin + count) of a dataset.
void read_rows(hid_t dataset, hid_t type, hsize_t begin, hsize_t count, void* values) {
    const hdf5::Handle space(H5Dget_space(dataset), H5Sclose, "reading a shape");
    hsize_t shape[2] = {0, 1};
    const int rank = H5Sget_simple_extent_ndims(space.id());
    H5Sget_simple_extent_dims(space.id(), shape, nullptr);
    const hsize_t start[2] = {begin, 0};
    const hsize_t size[2] = {count, shape[1]};
    hdf5::check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start, nullptr, size, nullptr),
                "selecting rows");
    const hdf5::Handle memory(H5Screate_simple(rank, size, nullptr), H5Sclose, "making a shape");
    hdf5::check(H5Dread(dataset, type, memory.id(), space.id(), H5P_DEFAULT, values),
                "reading rows");
}

hsize_t row_count(hid_t dataset) {
    const hdf5::Handle space(H5Dget_space(dataset), H5Sclose, "reading a shape");
    hsize_t shape[2] = {0, 1};
    H5Sget_simple_extent_dims(space.id(), shape, nullptr);
    return shape[0];
}

}  // namespace

class GeometryReader::Impl {
public:
    explicit Impl(const std::filesystem::path& path) : path_(path.string()) {
        guarded([&] {
            file_ = hdf5::open_to_read(path_);
            points_ = open_dataset("VTKHDF/Points");
            long long vertices = 0;
            read_rows(open_dataset("VTKHDF/NumberOfPoints").id(), H5T_NATIVE_LLONG, 0, 1,
                      &vertices);
            vertex_count_ = static_cast<std::size_t>(vertices);
            read_times();
        });
    }

    const std::vector<double>& times() const { return times_; }

    std::vector<float> positions(std::size_t step) const {
        std::vector<float> positions(3 * vertex_count_);
        guarded([&] {
            read_rows(points_.id(), H5T_NATIVE_FLOAT, step * vertex_count_, vertex_count_,
                      positions.data());
        });
        return positions;
    }

private:
    hdf5::Handle open_dataset(const char* name) const {
        return {H5Dopen2(file_.id(), name, H5P_DEFAULT), H5Dclose, std::string("opening ") + name};
    }

    /// A run may have been killed after it counted a step, and before it wrote its time.
    void read_times() {
        const hdf5::Handle steps(H5Gopen2(file_.id(), "VTKHDF/Steps", H5P_DEFAULT), H5Gclose,
                                 "opening VTKHDF/Steps");
        const auto counted = static_cast<hsize_t>(hdf5::read_int_attribute(steps.id(), "NSteps"));
        const hdf5::Handle values = open_dataset("VTKHDF/Steps/Values");
        times_.resize(std::min(counted, row_count(values.id())));
        if (times_.empty()) return;
        read_rows(values.id(), H5T_NATIVE_DOUBLE, 0, times_.size(), times_.data());
    }

    template <class Action>
    void guarded(Action action) const {
        const hdf5::Session session;
        try {
            action();
        } catch (const hdf5::Error& error) {
            throw UserError(path_ + ": cannot read the geometry: " + error.what());
        }
    }

    std::string path_;
    hdf5::Handle file_;
    hdf5::Handle points_;
    std::size_t vertex_count_ = 0;
    std::vector<double> times_;
};

GeometryReader::GeometryReader(const std::filesystem::path& path)
    : impl_(std::make_unique<Impl>(path)) {}

GeometryReader::~GeometryReader() = default;

std::size_t GeometryReader::steps() const { return impl_->times().size(); }

double GeometryReader::time(std::size_t step) const { return impl_->times()[step]; }

std::vector<float> GeometryReader::positions(std::size_t step) const {
    return impl_->positions(step);
}

}  // namespace weft
