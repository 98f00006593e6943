#include "simulation/output/geometry_reader.h"

#include <algorithm>
#include <string>

#include "runtime/error.h"
#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"

namespace weft {

class GeometryReader::Impl {
public:
    explicit Impl(const std::filesystem::path& path) : path_(path.string()) {
        guarded([&] {
            file_ = hdf5::open_to_read(path_);
            points_ = hdf5::open_dataset(file_.id(), "VTKHDF/Points");
            long long vertices = 0;
            const hdf5::Handle counts = hdf5::open_dataset(file_.id(), "VTKHDF/NumberOfPoints");
            hdf5::read_rows(counts.id(), H5T_NATIVE_LLONG, 0, 1, &vertices);
            vertex_count_ = static_cast<std::size_t>(vertices);
            read_times();
        });
    }

    const std::vector<double>& times() const { return times_; }

    std::vector<float> positions(std::size_t step) const {
        std::vector<float> positions(3 * vertex_count_);
        guarded([&] {
            hdf5::read_rows(points_.id(), H5T_NATIVE_FLOAT, step * vertex_count_, vertex_count_,
                            positions.data());
        });
        return positions;
    }

private:
    /// A run may have been killed after it counted a step, and before it wrote its time.
    void read_times() {
        const hdf5::Handle steps(H5Gopen2(file_.id(), "VTKHDF/Steps", H5P_DEFAULT), H5Gclose,
                                 "opening VTKHDF/Steps");
        const auto counted = static_cast<hsize_t>(hdf5::read_int_attribute(steps.id(), "NSteps"));
        const hdf5::Handle values = hdf5::open_dataset(file_.id(), "VTKHDF/Steps/Values");
        const std::vector<hsize_t> written = hdf5::shape_of(values.id());
        times_.resize(written.empty() ? 0 : std::min(counted, written.front()));
        if (times_.empty()) return;
        hdf5::read_rows(values.id(), H5T_NATIVE_DOUBLE, 0, times_.size(), times_.data());
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
