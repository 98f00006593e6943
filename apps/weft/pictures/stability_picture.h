#pragma once

#include <string>
#include <vector>

#include "apps/weft/pictures/map_panel.h"
#include "apps/weft/studies/stability/outcome.h"

namespace weft {

/// Maps of what holds: a row of panels per map of the suite, a panel per solver, a cell per case,
/// in the colour of its verdict; crossed out where the run was wrong without a word.
class StabilityPicture {
public:
    /// The rows must outlive it.
    explicit StabilityPicture(const std::vector<stability::Row>& rows);

    double width() const;
    double height() const;
    void draw(Canvas& canvas) const;

private:
    std::vector<const stability::Row*> rows_of(const std::string& group) const;
    void draw_map(Canvas& canvas, const stability::Map& map, double top) const;
    MapPanel panel_of(const stability::Map& map, const std::string& solver) const;
    void draw_legend(Canvas& canvas) const;

    const std::vector<stability::Row>& rows_;
    std::vector<stability::Map> maps_;  ///< that there are cases of
    std::vector<std::string> solvers_;
};

}  // namespace weft
