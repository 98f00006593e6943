#include "simulation/contact/body_pushes.h"

#include "kernels/contact/bodies.h"
#include "kernels/contact/stops.h"

namespace weft {

namespace {

constexpr int kFirstRoom = 16;  ///< of a row

}  // namespace

BodyPushes::BodyPushes(std::optional<ContactRows> contacts, const BodyColumns& columns,
                       Rubbing rubbing, Buffer<float>* multipliers, double h)
    : contacts_(contacts),
      columns_(columns),
      friction_(static_cast<float>(rubbing.friction)),
      creep_(static_cast<float>(rubbing.creep)),
      h2_(static_cast<float>(h * h)),
      none_("touching.no_multipliers", 1),
      multipliers_(multipliers),
      table_("touching.pushes", columns.by_strip, kFirstRoom),
      codes_(table_.add_column<int>("codes")),
      sides_(table_.add_column<float4>("sides")),
      slips_(table_.add_column<float4>("slips")),
      forces_(table_.add_column<float4>("forces")),
      points_(table_.add_column<float4>("points")),
      other_points_(table_.add_column<float4>("other_points")),
      presses_(table_.add_column<float>("presses")),
      standing_("touching.standing", static_cast<std::size_t>(columns.count)) {}

Launch BodyPushes::collect(Buffer<float4>& positions, Buffer<float4>& targets, Buffer<int>& bodies,
                           BodyGroups* groups) {
    if (!contacts_)
        return launch(kernels::collect_no_pushes, columns_.by_strip, positions, targets,
                      columns_.members, columns_.shares, columns_.rows, table_.counts(),
                      table_.needs(), standing_, kInstance);
    return launch(kernels::collect_pushes, columns_.by_strip, positions, targets, columns_.members,
                  columns_.shares, columns_.rows, bodies, groups->leaders, contacts_->table.rows(),
                  contacts_->table.counts(), contacts_->corner0, contacts_->corner1,
                  contacts_->corner2, contacts_->corner3, contacts_->normals, contacts_->weights,
                  contacts_->measures, contacts_->slips, multipliers_ ? *multipliers_ : none_,
                  table_.rows(), table_.counts(), table_.needs(), codes_, sides_, slips_, forces_,
                  points_, other_points_, presses_, standing_, columns_.count, groups->body_count(),
                  groups->level_count(), friction_, multipliers_ ? 1 : 0, 1.0f / h2_, kInstance);
}

Launch BodyPushes::collect_resting(const Resting& r) {
    return launch(kernels::collect_resting, columns_.by_strip, r.positions, r.previous,
                  r.seen_targets, r.starts, r.slips, r.obstacles, r.borne, r.solid, r.hardness,
                  r.meetings ? *r.meetings : r.positions, r.gradients ? *r.gradients : r.hardness,
                  columns_.members, columns_.shares, columns_.rows, table_.rows(), table_.counts(),
                  table_.needs(), codes_, sides_, slips_, forces_, points_, other_points_, presses_,
                  columns_.count, static_cast<int>(r.hardness.count()), r.body_count,
                  r.obstacle_count, r.reach, 1.0f / h2_, r.meetings ? 1 : 0, r.gradients ? 1 : 0,
                  kInstance);
}

Launch BodyPushes::collect_stops(const Stops& s) {
    return launch(kernels::collect_stops, columns_.by_strip, s.positions, s.targets, s.anchors,
                  s.least, s.planes_of.rows(), s.planes_of.counts(), s.planes, s.hardness,
                  s.scene_bodies, s.borne, columns_.members, columns_.shares, columns_.rows,
                  table_.rows(), table_.counts(), table_.needs(), codes_, sides_, slips_, forces_,
                  points_, other_points_, presses_, columns_.count, s.body_count,
                  s.scene_body_count, s.soft, kInstance);
}

void BodyPushes::add_collect_accesses(Step::Adding& task, const Region& region, int first,
                                      int last) {
    if (contacts_) contacts_->add_reads(task, region.begin, region.end, first, last);
    if (multipliers_) task.reads(*multipliers_, contacts_->table.entries());
    const int column = columns_.by_strip.item(region.begin);
    const int end = columns_.by_strip.item(region.end);
    task.updates(table_.counts(), column, end)
        .updates(table_.needs(), column, end)
        .updates(standing_, column, end)
        .updates(presses_, table_.entries())
        .updates(codes_, table_.entries());
    for (Buffer<float4>* entries : {&sides_, &slips_, &forces_, &points_, &other_points_}) {
        task.updates(*entries, table_.entries());
    }
}

Launch BodyPushes::add(Buffer<int>& column_bodies, Buffer<float>& masses, Buffer<float4>& moments,
                       Buffer<float4>& motions, Buffer<float4>& strains, Buffer<float4>& bearings,
                       const Round& round, Buffer<float4>& partials) {
    const int body_count = static_cast<int>(masses.count());
    return launch(kernels::add_pushed_lags, columns_.by_strip, standing_, column_bodies, masses,
                  moments, motions, strains, bearings, table_.rows(), table_.counts(), codes_,
                  sides_, slips_, forces_, points_, other_points_, presses_, partials, friction_,
                  creep_, h2_, round.is_rubbed, round.has_moved, round.is_strained, round.is_strain,
                  round.level, columns_.count, body_count);
}

void BodyPushes::add_sum_accesses(Step::Adding& task, const Region& region) {
    const int column = columns_.by_strip.item(region.begin);
    const int end = columns_.by_strip.item(region.end);
    task.reads(table_.counts(), column, end)
        .reads(standing_, column, end)
        .updates(presses_, table_.entries())
        .reads(codes_, table_.entries());
    for (Buffer<float4>* entries : {&sides_, &slips_, &forces_, &points_, &other_points_}) {
        task.reads(*entries, table_.entries());
    }
}

}  // namespace weft
