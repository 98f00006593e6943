#include "apps/weft/studies/study_files.h"

#include "apps/weft/output/output_file.h"
#include "apps/weft/pictures/error_picture.h"
#include "apps/weft/pictures/stability_picture.h"
#include "apps/weft/pictures/trajectory_picture.h"
#include "apps/weft/pictures/write_pictures.h"
#include "apps/weft/studies/error_report.h"
#include "apps/weft/studies/stability/report.h"
#include "apps/weft/studies/trajectory_report.h"

namespace weft {

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

std::string write_study(const std::filesystem::path& folder,
                        const std::vector<stability::Row>& rows) {
    write_output(folder / "stability.csv", to_csv(rows));
    return folder.string() + ": stability.csv, " +
           write_pictures(folder, "stability", StabilityPicture(rows));
}

std::string write_study(const std::filesystem::path& folder, const stability::Advice& advice) {
    write_output(folder / "settings.csv", to_csv(advice));
    return folder.string() + ": settings.csv";
}

}  // namespace weft
