#include "simulation/solver/newton/conjugate_gradients.h"

#include <algorithm>
#include <numeric>

#include "kernels/descent/energy_terms.h"
#include "kernels/newton/conjugate_gradients.h"
#include "simulation/solver/accesses.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void append(std::vector<Launch>& launches, std::vector<Launch> more) {
    std::ranges::move(more, std::back_inserter(launches));
}

}  // namespace

ConjugateGradients::ConjugateGradients(Model& model, DescentSubstep& substep,
                                       const VertexGraph& graph, Buffer<float>& control)
    : model_(model),
      substep_(substep),
      items_(model.strips),
      sums_("newton.sums", 9 * model.positions->count()),
      hessian_(model, items_),
      holds_(NewtonHolds::of(model, substep, control)),
      coarse_(model, make_aggregates(model, graph)),
      halo_(model),
      before_("newton.before", model.positions->count()),
      after_("newton.after", model.positions->count()),
      factors_("newton.factors", 6 * model.positions->count()),
      residuals_("newton.residuals", model.positions->count()),
      preconditioned_("newton.preconditioned", model.positions->count()),
      products_("newton.products", 3 * model.positions->count()),
      searches_("newton.searches", 3 * model.positions->count()),
      applied_("newton.applied", 3 * model.positions->count()),
      moves_("newton.moves", 3 * model.positions->count()),
      strip_of_("newton.strip_of", model.positions->count()),
      places_("newton.places", model.positions->count()),
      columns_("newton.columns", 4 * kDotColumns * at(model.strips.count())),
      column_begin_("newton.strip_columns", model.strips.begin.size()),
      strip_columns_("newton.first_columns", at(model.strips.count())),
      strip_begin_("newton.strips", model.strips.begin.size()),
      column_sums_("newton.column_sums", 2 * kDotColumns * at(model.strips.count())),
      gammas_("newton.gammas", at(model.strips.count())),
      deltas_("newton.deltas", at(model.strips.count())),
      scalars_("newton.scalars", at(model.strips.count())),
      by_strip_{&strip_begin_, 0, 1, model.strips.count()},
      columns_by_strip_{&column_begin_, 0, 1, model.strips.count()} {
    static_assert(kDotColumns == WEFT_DOT_COLUMNS);
    if (substep.contact() != nullptr) {
        contacts_ = std::make_unique<ContactHessian>(model, *substep.contact());
    }
    std::iota(strip_begin_.span().begin(), strip_begin_.span().end(), 0);
    place_terms();
}

/// A strip's terms fill whole rows of columns; what fills them up is 0 for ever.
void ConjugateGradients::place_terms() {
    const auto& begin = model_.strips.begin;
    int base = 0;
    for (int s = 0; s < model_.strips.count(); ++s) {
        const int count = begin[at(s + 1)] - begin[at(s)];
        const int rows = (count + kDotColumns - 1) / kDotColumns;
        for (int v = begin[at(s)]; v < begin[at(s + 1)]; ++v) {
            strip_of_[at(v)] = s;
            places_[at(v)] = base + v - begin[at(s)];
        }
        strip_columns_[at(s)] = 2 * kDotColumns * s;
        column_begin_[at(s + 1)] = 2 * kDotColumns * (s + 1);
        for (int c = 0; c < kDotColumns; ++c) {
            for (const int part : {0, 1}) {
                const auto column = at(2 * kDotColumns * s + part * kDotColumns + c);
                columns_[2 * column] = base + c;
                columns_[2 * column + 1] = rows;
            }
        }
        base += rows * kDotColumns;
    }
    delta_offset_ = base;
    for (int s = 0; s < model_.strips.count(); ++s) {
        for (int c = 0; c < kDotColumns; ++c) {
            columns_[2 * at(2 * kDotColumns * s + kDotColumns + c)] += delta_offset_;
        }
    }
    terms_ = std::make_unique<Buffer<float>>("newton.terms", 2 * at(base));
}

std::vector<Launch> ConjugateGradients::linearise() {
    auto launches = hessian_.gather_gradients(*model_.positions, sums_);
    append(launches, hessian_.couple(linearised_at()));
    append(launches, hessian_.sum_rows(sums_));
    if (contacts_) {
        launches.push_back(
            substep_.contact()->gather_at(kInnerPhase, *model_.positions, items_, sums_));
        launches.push_back(contacts_->couple());
    }
    if (holds_) launches.push_back(holds_->find(sums_));
    launches.push_back(launch(kernels::begin_conjugate_gradients, model_.vertices(),
                              *model_.positions, substep_.targets(), sums_, holds(), factors_,
                              residuals_, searches_, applied_, moves_, model_.vertex_count(),
                              have_holds(), static_cast<float>(1.0 / (model_.h * model_.h))));
    launches.push_back(launch(kernels::begin_steps, by_strip_, scalars_));
    launches.push_back(coarse_.restrict(residuals_));
    return launches;
}

std::vector<Launch> ConjugateGradients::correct() {
    return {coarse_.correct(),
            launch(kernels::precondition, model_.vertices(), residuals_, factors_,
                   coarse_.corrections(), coarse_.aggregate_of(), holds(), preconditioned_,
                   model_.vertex_count(), have_holds())};
}

std::vector<Launch> ConjugateGradients::product() {
    auto launches = hessian_.multiply(preconditioned_, products_);
    if (contacts_) launches.push_back(contacts_->multiply(preconditioned_, products_));
    launches.push_back(launch(kernels::finish_product, model_.vertices(), *model_.positions,
                              residuals_, preconditioned_, holds(), products_, places_, *terms_,
                              model_.vertex_count(), delta_offset_, have_holds(),
                              static_cast<float>(1.0 / (model_.h * model_.h))));
    launches.push_back(launch(kernels::add_terms, columns_by_strip_, *terms_, columns_,
                              column_sums_, kDotColumns));
    launches.push_back(launch(kernels::add_dot_columns, by_strip_, column_sums_, strip_columns_,
                              gammas_, deltas_));
    return launches;
}

std::vector<Launch> ConjugateGradients::advance() {
    return {
        launch(kernels::find_step, by_strip_, gammas_, deltas_, scalars_, model_.strips.count()),
        launch(kernels::take_step, model_.vertices(), scalars_, strip_of_, preconditioned_,
               products_, searches_, applied_, moves_, residuals_, model_.vertex_count()),
        coarse_.restrict(residuals_)};
}

std::vector<BufferStorage*> ConjugateGradients::scratch() {
    std::vector<BufferStorage*> buffers = hessian_.scratch();
    buffers.insert(buffers.end(),
                   {&sums_, &before_, &after_, &factors_, &residuals_, &preconditioned_, &products_,
                    &searches_, &applied_, &moves_, terms_.get()});
    return buffers;
}

/// Contacts reach from anywhere to anywhere.
std::pair<int, int> ConjugateGradients::around(int first, int last) const {
    return contacts_ ? std::pair(0, model_.vertex_count()) : halo_.around(first, last);
}

void ConjugateGradients::add_vectors(Step::Adding& task, int first, int last) {
    for (Buffer<float>* vector : {&searches_, &applied_, &moves_}) {
        add_columns(task, *vector, model_.vertex_count(), 3, first, last, true);
    }
    task.updates(residuals_, first, last);
}

void ConjugateGradients::add_linearise_accesses(Step::Adding& task, int first_strip,
                                                int end_strip) {
    const auto [first, last] = substep_.vertices(first_strip, end_strip);
    const auto [halo_begin, halo_end] = around(first, last);
    if (contacts_) contacts_->add_couple_accesses(task, first_strip, end_strip);
    if (holds_) holds_->add_find_accesses(task, first, last);
    task.reads(*model_.positions, halo_begin, halo_end)
        .reads(before_, halo_begin, halo_end)
        .reads(after_, halo_begin, halo_end)
        .reads(substep_.targets(), first, last)
        .updates(scalars_, first_strip, end_strip);
    hessian_.add_accesses(task, first_strip, end_strip, true);
    add_columns(task, factors_, model_.vertex_count(), 6, first, last, true);
    add_vectors(task, first, last);
    coarse_.add_restrict_accesses(task, first_strip, end_strip);
}

void ConjugateGradients::add_correct_accesses(Step::Adding& task, int first_strip, int end_strip) {
    const auto [first, last] = substep_.vertices(first_strip, end_strip);
    task.reads(residuals_, first, last).updates(preconditioned_, first, last);
    if (holds_) task.reads(holds_->holds(), first, last);
    add_columns(task, factors_, model_.vertex_count(), 6, first, last, false);
    coarse_.add_correct_accesses(task, first_strip, end_strip);
}

void ConjugateGradients::add_product_accesses(Step::Adding& task, int first_strip, int end_strip) {
    const auto [first, last] = substep_.vertices(first_strip, end_strip);
    const auto [halo_begin, halo_end] = around(first, last);
    if (contacts_) contacts_->add_multiply_accesses(task, first_strip, end_strip);
    if (holds_) task.reads(holds_->holds(), first, last);
    task.reads(*model_.positions, first, last)
        .reads(residuals_, first, last)
        .reads(preconditioned_, halo_begin, halo_end)
        .updates(gammas_, first_strip, end_strip)
        .updates(deltas_, first_strip, end_strip);
    hessian_.add_accesses(task, first_strip, end_strip, false);
    add_columns(task, products_, model_.vertex_count(), 3, first, last, true);
}

void ConjugateGradients::add_advance_accesses(Step::Adding& task, int first_strip, int end_strip) {
    const auto [first, last] = substep_.vertices(first_strip, end_strip);
    task.reads(gammas_, 0, model_.strips.count())
        .reads(deltas_, 0, model_.strips.count())
        .updates(scalars_, first_strip, end_strip)
        .reads(preconditioned_, first, last);
    add_columns(task, products_, model_.vertex_count(), 3, first, last, false);
    add_vectors(task, first, last);
    coarse_.add_restrict_accesses(task, first_strip, end_strip);
}

}  // namespace weft
