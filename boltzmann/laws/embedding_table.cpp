// Splines of embedding energies.
#include <boltzmann/laws/embedding_table.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double embedding_error = 1e-6;
constexpr std::size_t finest_embedding = 4096;

Table through_points(std::vector<double> const& energies, double spacing) {
  std::vector<TablePoint> points;
  for (std::size_t k = 0; k < energies.size(); ++k)
    points.push_back({std::sqrt(spacing * static_cast<double>(k)), energies[k]});
  for (std::size_t fineness = 64;; fineness *= 2) {
    Table table(points, {}, PerOctave{fineness});
    if (table.error().relative <= embedding_error || fineness >= finest_embedding) return table;
  }
}

}  // namespace

EmbeddingTable::EmbeddingTable(std::vector<double> const& energies, double spacing)
    : table_(through_points(energies, spacing)) {}

EmbeddingTable::EmbeddingTable(std::function<double(double)> const& energy, double greatest)
    : table_([&](double root) { return energy(root * root); }, 0, std::sqrt(greatest), Tolerance{embedding_error}) {}

void EmbeddingTable::at(double const* density, std::size_t size, double* energy, double* slope) const {
  double const greatest = table_.knots().greatest;
  for (std::size_t k = 0; k < size; ++k) {
    auto const value = table_.at(std::min(density[k], greatest));
    energy[k] = value.energy + std::max(density[k] - greatest, 0.0) * value.slope;
    slope[k] = value.slope;
  }
}

}  // namespace boltzmann
