#pragma once

#include "apps/weft/pictures/map_panel.h"
#include "apps/weft/studies/machine_study.h"

namespace weft {

/// Which plan wins on which machine: a panel per number of devices, waits across, ratios up; a row
/// of panels for what fast devices are fast at.
class MachinePicture {
public:
    /// The study must outlive it.
    explicit MachinePicture(const MachineStudy& study);

    double width() const;
    double height() const;
    void draw(Canvas& canvas) const;

private:
    MapPanel panel_of(FasterAt faster, int devices) const;

    const MachineStudy& study_;
    std::vector<int> devices_;
};

}  // namespace weft
