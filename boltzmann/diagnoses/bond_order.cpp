// Harmonics of the directions to neighbours, particle by particle.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/bond_harmonics.hpp>
#include <boltzmann/diagnoses/bond_order.hpp>
#include <boltzmann/diagnoses/chosen.hpp>
#include <boltzmann/diagnoses/near_images.hpp>
#include <boltzmann/diagnoses/unknown.hpp>

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace boltzmann {

BondOrder::BondOrder(std::vector<AnyEnsemble const*> const& available, Options options)
    : options_(std::move(options)), label_(options_.label) {
  chosen_names(available, options_.ensembles);
  dimension_ = available.front()->dimension();
  if (dimension_ == 1) throw Error("bond-order: on a line neighbours have no directions");
  if (options_.ensembles.size() > 1)
    throw Error(fmt::format("bond-order: of one ensemble or of all particles, not of {}", join(options_.ensembles)));
  if (!(options_.range > 0))
    throw Error("bond-order: it needs a positive 'range' within which particles are neighbours");
  if (options_.order < 1 || options_.order > BondHarmonics::largest_order)
    throw Error(fmt::format("bond-order: the order is 1 to {}, not {}", BondHarmonics::largest_order, options_.order));
  if (label_.empty() && !options_.ensembles.empty()) label_ = options_.ensembles[0];
}

std::vector<Column> BondOrder::columns() const {
  std::string const name = fmt::format("{}{}", dimension_ == 3 ? "q" : "psi", options_.order);
  return {{labelled(label_, name), dimensions::none},
          {labelled(label_, name + " of all"), dimensions::none},
          {labelled(label_, "neighbours"), dimensions::none}};
}

void BondOrder::check(Box const& box) const {
  refuse_shear(box, "bond-order");
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a) && options_.range > 0.5 * box.length(a))
      throw Error(fmt::format("bond-order: the range {} is more than half of periodic axis {}",
                              box.spoken_units().text(options_.range, dimensions::length, 6), "xyz"[a]));
}

template <int D>
BondOrder::Local BondOrder::find(Sample const& sample) const {
  Box const& box = sample.box;
  std::vector<double> places;
  for (auto const* ensemble : sample.ensembles) {
    if (!options_.ensembles.empty() && ensemble->name() != options_.ensembles[0]) continue;
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      for (int a = 0; a < D; ++a) {
        double const x = ensemble->row(i)[a];
        places.push_back(box.periodic(a) ? box.wrapped(x, a) : x);
      }
  }
  std::size_t const size = places.size() / D;
  Local local{std::vector<double>(size, unknown), std::vector<double>(size, 0.0), unknown};
  if (size == 0) return local;
  Cells const cells(D, places.data(), D, size, options_.range, sample.threads);
  std::vector<BondHarmonics> own(size, BondHarmonics(D, options_.order));
  double const reach2 = options_.range * options_.range;
  for_ranges(size, 64, threads_for(size, 16, sample.threads), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      each_near<D>(cells, &places[D * i], box, options_.range, [&](std::size_t j, double const* image) {
        if (j == i) return;
        double way[3] = {0, 0, 0}, r2 = 0;
        for (int a = 0; a < D; ++a) way[a] = places[D * j + a] - image[a];
        for (int a = 0; a < D; ++a) r2 += way[a] * way[a];
        if (r2 < reach2 && r2 > 0) own[i].add(way, std::sqrt(r2));
      });
      local.order[i] = own[i].order();
      local.neighbours[i] = own[i].count();
    }
  });
  BondHarmonics all(D, options_.order);
  ExactSum real, imaginary;
  double with = 0;
  for (auto const& one : own) {
    all.add(one);
    if (one.count() > 0) real += one.mean().real(), imaginary += one.mean().imag(), with += 1;
  }
  local.whole = D == 3 ? all.order() : with > 0 ? std::hypot(real.value(), imaginary.value()) / with : unknown;
  return local;
}

BondOrder::Local BondOrder::local(Sample const& sample) const {
  check(sample.box);
  return dimension_ == 2 ? find<2>(sample) : find<3>(sample);
}

void BondOrder::measure(Sample const& sample, std::vector<double>& values) {
  Local const found = local(sample);
  ExactSum order;
  double with = 0, neighbours = 0;
  for (std::size_t i = 0; i < found.order.size(); ++i) {
    neighbours += found.neighbours[i];
    if (found.neighbours[i] > 0) order += found.order[i], with += 1;
  }
  auto const size = static_cast<double>(found.order.size());
  values.insert(values.end(),
                {with > 0 ? order.value() / with : unknown, found.whole, size > 0 ? neighbours / size : unknown});
}

}  // namespace boltzmann
