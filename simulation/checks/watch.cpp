#include "simulation/checks/watch.h"

namespace weft {

namespace {

Energies energies_of(const Model& model, double time) {
    return measure_energies(model, model.positions->span(), model.velocities->span(), time);
}

Alarm alarm_of(const EnergyAlarm& alarm) {
    return {alarm.is_explosion ? Alarm::Kind::kExplosion : Alarm::Kind::kDoubt, alarm.what, {}};
}

}  // namespace

Watch::Watch(const Model& model, bool keeps_account, int threads)
    : threads_(threads),
      keeps_account_(keeps_account),
      account_(model, energies_of(model, 0.0)),
      bodies_(model) {}

Watch::Look Watch::look(const Model& model, const SimulationState& before, double start, double end,
                        const StoredInContacts& contacts) const {
    Look look;
    threads_.execute([&] { look = look_here(model, before, start, end, contacts); });
    return look;
}

/// What contacts have stored is found out by the substep that finds them.
double Watch::found(const StoredInContacts& contacts) const {
    if (knows_contacts_) return 0.0;
    return contacts.start - account_.last().energies.contact.value_or(0.0);
}

Watch::Look Watch::look_here(const Model& model, const SimulationState& before, double start,
                             double end, const StoredInContacts& contacts) const {
    const StateLook state = look_at_state(model, end, contacts.end, keeps_account_);
    Look look;
    if (const auto& bad = state.non_finite) {
        look.alarm = {Alarm::Kind::kNoState, bad->what, bad->vertex};
        return look;
    }
    look.strain = state.strain;
    if (keeps_account_) {
        look.entry = account_.with_frame(start, outside_work(model, before, start, end),
                                         state.energies, found(contacts));
    }
    if (const auto& bad = state.beyond_guard) {
        look.alarm = {Alarm::Kind::kExplosion, bad->what, bad->vertex};
    } else if (keeps_account_) {
        look.bodies = bodies_.measure(model, end);
        auto alarm = account_.look(look.entry, look.strain, model);
        if (!alarm) alarm = bodies_.look(model, look.bodies);
        if (alarm) look.alarm = alarm_of(*alarm);
    }
    return look;
}

void Watch::accept(const Look& look, bool forgives) {
    if (!keeps_account_) return;
    account_.accept(look.entry);
    knows_contacts_ = true;
    if (!forgives) return;
    account_.forgive(look.alarm && look.alarm->kind == Alarm::Kind::kExplosion);
    bodies_.forgive(look.bodies);
}

void Watch::restart(const Model& model, double time,
                    const std::optional<std::array<double, 8>>& saved) {
    knows_contacts_ = saved.has_value();
    const Energies now = energies_of(model, time);
    if (saved) {
        account_.restore(*saved, now);
    } else {
        account_ = EnergyAccount(model, now);
        bodies_ = BodyAccounts(model);
    }
}

}  // namespace weft
