#include "apps/weft/studies/study_files.h"

#include <fmt/format.h>

#include <memory>

#include "apps/weft/output_file.h"
#include "apps/weft/pictures/error_picture.h"
#include "apps/weft/pictures/trajectory_picture.h"
#include "apps/weft/studies/error_report.h"
#include "apps/weft/studies/trajectory_report.h"

namespace weft {

namespace {

/// folder/name.svg, and name.png where there is cairo.
template <class Picture>
std::string write_pictures(const std::filesystem::path& folder, const std::string& name,
                           const Picture& picture) {
    const auto write = [&](std::unique_ptr<Canvas> canvas, const std::string& file) {
        picture.draw(*canvas);
        write_output(folder / file, canvas->finish());
    };
    write(make_svg_canvas(picture.width(), picture.height()), name + ".svg");
    auto png = make_png_canvas(picture.width(), picture.height());
    if (!png) return fmt::format("{0}.svg (no {0}.png: this weft was built without cairo)", name);
    write(std::move(png), name + ".png");
    return fmt::format("{0}.svg, {0}.png", name);
}

}  // namespace

std::string write_study(const std::filesystem::path& folder, const ErrorStudy& study) {
    write_output(folder / "error.csv", to_csv(study));
    std::string files = folder.string() + ": error.csv, ";
    if (!study.minimum.x.empty()) {
        write_error_file(folder / "error.h5", study);
        files += "error.h5, ";
    }
    return files + write_pictures(folder, "error", ErrorPicture(study));
}

std::string write_study(const std::filesystem::path& folder, const TrajectoryStudy& study) {
    write_output(folder / "trajectory.csv", to_csv(study));
    write_trajectory_file(folder / "trajectory.h5", study);
    return folder.string() + ": trajectory.csv, trajectory.h5, " +
           write_pictures(folder, "trajectory", TrajectoryPicture(study));
}

}  // namespace weft
