// Neighbours by cells: a search in the box around each image of a particle.
#include <boltzmann/boundaries/images.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/bond_harmonics.hpp>
#include <boltzmann/diagnoses/neighbour_fields.hpp>
#include <boltzmann/neighbours/cells.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t not_among = static_cast<std::size_t>(-1);

/// Wraps a position into the box, as Images require. Through an end of a sheared box's gradient it becomes its image.
template <int D>
std::array<double, D> inside(Box const& box, double const* x) {
  std::array<double, D> place;
  std::copy_n(x, D, place.begin());
  if (box.sheared()) {
    auto const g = static_cast<std::size_t>(box.shear().gradient), f = static_cast<std::size_t>(box.shear().flow);
    double const wrapped = box.wrapped(place[g], box.shear().gradient);
    place[f] += std::round((wrapped - place[g]) / box.length(box.shear().gradient)) * box.slide_in_lattice();
  }
  for (int a = 0; a < D; ++a)
    if (box.periodic(a)) place[static_cast<std::size_t>(a)] = box.wrapped(place[static_cast<std::size_t>(a)], a);
  return place;
}

/// Particles that may be neighbours, sorted into cells.
template <int D>
class Surroundings {
 public:
  Surroundings(Box const& box, std::vector<AnyEnsemble*> const& among, double range, int threads)
      : box_(box), images_(box), range_(range) {
    for (auto const* ensemble : among) {
      first_.push_back({ensemble, places_.size() / D});
      for (std::size_t i = 0; i < ensemble->size(); ++i) {
        auto const place = inside<D>(box, ensemble->row(i));
        if (!std::all_of(place.begin(), place.end(), [](double x) { return std::isfinite(x); }))
          throw PhysicsFailure(fmt::format("particle {} of '{}' is not at a finite position", i, ensemble->name()));
        places_.insert(places_.end(), place.begin(), place.end());
      }
    }
    cells_ = Cells(D, places_.data(), D, places_.size() / D, range, threads);
  }

  /// Calls near(way, square of its length) for each neighbour of particle i, with the vector to it.
  template <class Near>
  void each(AnyEnsemble const& ensemble, std::size_t i, Near const& near) const {
    if (places_.empty()) return;
    std::size_t own = not_among;
    for (auto const& [one, first] : first_)
      if (one == &ensemble) own = first + i;
    std::array<double, 3> place{};  // of all axes: gcc can't prove that none beyond D is read
    auto const here = inside<D>(box_, ensemble.row(i));
    std::copy(here.begin(), here.end(), place.begin());
    images_.each(place.data(), range_, [&](Turns const& turns, std::array<double, 3> const& image) {
      bool const itself = turns == Turns{};
      cells_.near(image.data(), range_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          std::size_t const j = cells_.items()[k];
          double way[3] = {0, 0, 0}, r2 = 0;
          for (int a = 0; a < D; ++a)
            way[a] = places_[D * j + static_cast<std::size_t>(a)] - image[static_cast<std::size_t>(a)];
          for (double const w : way) r2 += w * w;
          if (!(r2 < range_ * range_) || (j == own && (itself || r2 == 0))) continue;
          for (int a = 0; a < D; ++a)
            if (turns[static_cast<std::size_t>(a)] != 0 && !box_.periodic(a)) way[a] = -way[a];  // reflected
          near(way, r2);
        }
      });
    });
  }

 private:
  Box const& box_;
  Images images_;
  double range_;
  std::vector<double> places_;
  std::vector<std::pair<AnyEnsemble const*, std::size_t>> first_;  // where the positions of each ensemble begin
  Cells cells_;
};

}  // namespace

void NeighbourFields::find(AnyEnsemble& ensemble, NeighbourField field) {
  Field const& of_class = ensemble.field(field.field);
  if (of_class.components != 1)
    throw Error(
        fmt::format("neighbours: '{}' has {} components; one number is found", field.field, of_class.components));
  if (!(field.range > 0) || !std::isfinite(field.range))
    throw Error(
        fmt::format("neighbours: '{}' needs a distance, positive, within which particles are neighbours", field.field));
  if (field.order > 0 && ensemble.dimension() == 1) throw Error("bond_order: on a line neighbours have no directions");
  if (field.order > BondHarmonics::largest_order)
    throw Error(fmt::format("bond_order: it is 1 to {}, not {}", BondHarmonics::largest_order, field.order));
  add(ensemble);
  for (auto* other : field.among) add(*other);
  int const offset = of_class.offset;
  found_.push_back({&ensemble, std::move(field), offset});
}

template <int D>
void NeighbourFields::find_in(Found const& found) const {
  auto const& among = found.field.among.empty() ? ensembles() : found.field.among;
  Surroundings<D> const around(box(), among, found.field.range, threads());
  AnyEnsemble& ensemble = *found.ensemble;
  for_share(ensemble, 64, threads_for(ensemble.size(), 16, threads()), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double& value = ensemble.row(i)[found.offset];
      if (found.field.order > 0) {
        BondHarmonics bonds(D, found.field.order);
        around.each(ensemble, i, [&](double const* way, double r2) {
          if (r2 > 0) bonds.add(way, std::sqrt(r2));
        });
        value = bonds.order();
      } else {
        double count = 0;
        around.each(ensemble, i, [&](double const*, double) { count += 1; });
        value = count;
      }
    }
  });
}

void NeighbourFields::complete(double) {
  if (division_) division_->make_whole();
  for (auto const& found : found_) {
    if (box().dimension() == 1) find_in<1>(found);
    if (box().dimension() == 2) find_in<2>(found);
    if (box().dimension() == 3) find_in<3>(found);
  }
}

bool NeighbourFields::derives(AnyEnsemble const& ensemble, Field const& field) const {
  return std::any_of(found_.begin(), found_.end(),
                     [&](Found const& found) { return found.ensemble == &ensemble && found.offset == field.offset; });
}

EnergyAndVirial NeighbourFields::measure(double) {
  auto measures = EnergyAndVirial::known();
  measures.reciprocal = true;
  for (auto const* ensemble : ensembles()) {
    measures.per_particle.emplace_back(ensemble->size(), 0.0);
    measures.virial_per_particle.emplace_back(9 * ensemble->size(), 0.0);
  }
  return measures;
}

}  // namespace boltzmann
