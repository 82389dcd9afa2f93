// Tuples of molecules: computes the forces of each tuple, then each particle sums its forces in the order of tuples.
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/formulas/machine_code.hpp>
#include <boltzmann/laws/angular_program.hpp>
#include <boltzmann/schemes/molecules/tuple_formula_kernels.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

constexpr std::size_t tuples_grain = 512, members_grain = 2048;
constexpr double tuple_work = 1;

char const* name_of_tuple(std::size_t each) { return each == 3 ? "angle" : "dihedral"; }

std::string number_of_tuple(std::size_t k) { return fmt::format("number {} from 0", k); }

template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> tuples_of(std::vector<std::uint32_t> const& members) {
  std::vector<std::array<std::uint32_t, N>> all(members.size() / N);
  for (std::size_t k = 0; k < members.size(); ++k) all[k / N][k % N] = members[k];
  return all;
}

void check_tuples(AnyEnsemble const& ensemble, std::size_t each, std::vector<std::uint32_t> const& members) {
  char const* name = name_of_tuple(each);
  int const least = each == 3 ? 2 : 3;
  if (ensemble.dimension() < least) throw Error(fmt::format("there are no {}s in {}D", name, ensemble.dimension()));
  if (ensemble.influence_size() != static_cast<std::size_t>(ensemble.dimension()) || !ensemble.find_field("mass"))
    throw Error(fmt::format("{}s give forces; particles of class {} are not moved by forces alone", name,
                            ensemble.class_name()));
  for (std::size_t first = 0; first < members.size(); first += each)
    for (std::size_t m = 0; m < each; ++m) {
      std::uint32_t const i = members[first + m];
      if (i >= ensemble.size())
        throw Error(fmt::format("{} {} names particle {}, but '{}' has {} (0 to {})", name, first / each, i,
                                ensemble.name(), ensemble.size(), ensemble.size() == 0 ? 0 : ensemble.size() - 1));
      for (std::size_t n = 0; n < m; ++n)
        if (members[first + n] == i) throw Error(fmt::format("{} {} names particle {} twice", name, first / each, i));
    }
  std::string const what = fmt::format("{}s of '{}'", name, ensemble.name());
  if (each == 3)
    refuse_repeated(tuples_of<3>(members), number_of_tuple, what);
  else
    refuse_repeated(tuples_of<4>(members), number_of_tuple, what);
}

}  // namespace

struct MoleculeScheme::Group {
  AnyEnsemble* ensemble;
  std::size_t each;  // 3: angles, 4: dihedrals
  std::vector<std::uint32_t> members;
  TupleKernels kernels;
  LawPointer law;
  bool reads_outside;
  std::vector<std::uint32_t> slot;  // for each member: the slot for its force
  std::vector<std::size_t> start;   // for each particle: its first slot
  std::vector<double> forces;
  // In a divided run: data of tuples that include an owned particle of this rank.
  std::vector<std::uint32_t> own_members = {}, own_slot = {};
  std::uint64_t division = 0, changes = 0;  // counters at the time of their selection

  std::size_t count() const { return members.size() / each; }

  /// The slots of a particle are contiguous, in the order of tuples.
  void assign_slots() {
    start.assign(ensemble->size() + 1, 0);
    for (auto const i : members) ++start[i + 1];
    for (std::size_t i = 0; i < ensemble->size(); ++i) start[i + 1] += start[i];
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    for (auto const i : members) slot.push_back(static_cast<std::uint32_t>(next[i]++));
    forces.resize(members.size() * static_cast<std::size_t>(ensemble->dimension()));
  }

  /// Finds the tuples of this rank's particles, unless they are up to date.
  void find_own(Division const& of) {
    if (division == of.id() && changes == of.changes()) return;
    division = of.id();
    changes = of.changes();
    std::vector<std::uint32_t> tuple_of(members.size());  // the tuple that fills each slot
    for (std::size_t k = 0; k < members.size(); ++k) tuple_of[slot[k]] = static_cast<std::uint32_t>(k / each);
    std::vector<bool> own(count());
    for (auto const& [begin, end] : ensemble->share()->stretches)
      for (std::size_t k = start[begin]; k < start[end]; ++k) own[tuple_of[k]] = true;
    own_members.clear();
    own_slot.clear();
    for (std::size_t k = 0; k < members.size(); ++k)
      if (own[k / each]) own_members.push_back(members[k]), own_slot.push_back(slot[k]);
  }

  TupleTask task(Box const& box) const {
    if (start.size() != ensemble->size() + 1)
      throw Error(fmt::format("ensemble '{}' had {} particles when it got {}s, now it has {}", ensemble->name(),
                              start.size() - 1, name_of_tuple(each), ensemble->size()));
    TupleTask t;
    t.target = ensemble->row(0);
    t.targets = ensemble->size();
    t.target_row_stride = ensemble->stride();
    t.members = members.data();
    t.slot = slot.data();
    find_images(t, *ensemble, box);
    return t;
  }

  void add_influences(Box const& box, double quantum, Division const* divided, int threads) {
    TupleTask t = task(box);
    std::size_t tuples = count();
    if (divided) {
      find_own(*divided);
      t.members = own_members.data();
      t.slot = own_slot.data();
      tuples = own_members.size() / each;
    }
    t.influence = forces.data();
    t.rounding = 1.5 * 4503599627370496.0 * quantum;
    for_ranges(tuples, tuples_grain, threads_for(tuples, tuple_work, threads),
               [&](std::size_t begin, std::size_t end) { kernels.forces(law.get(), t, begin, end); });
    std::size_t const D = static_cast<std::size_t>(ensemble->dimension());
    for_share(*ensemble, members_grain, threads_for(ensemble->size(), 1, threads),
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  double* const influence = ensemble->influence(i);
                  for (std::size_t k = start[i]; k < start[i + 1]; ++k)
                    for (std::size_t a = 0; a < D; ++a) influence[a] += forces[k * D + a];
                }
              });
  }
};

MoleculeScheme::MoleculeScheme(Box box) : Scheme(std::move(box)) {}
MoleculeScheme::~MoleculeScheme() = default;

void MoleculeScheme::add_tuples(AnyEnsemble& ensemble, std::size_t each, std::vector<std::uint32_t> members,
                                TupleKernels kernels, LawPointer law, bool reads_outside) {
  check_tuples(ensemble, each, members);
  add(ensemble);
  groups_.push_back(std::make_unique<Group>(
      Group{&ensemble, each, std::move(members), kernels, std::move(law), reads_outside, {}, {}, {}}));
  groups_.back()->assign_slots();
  changed();
}

void MoleculeScheme::add_tuples(AnyEnsemble& ensemble, std::size_t each, std::vector<std::uint32_t> members,
                                FormulaLaw const& law) {
  check_tuples(ensemble, each, members);
  AngularProgram program = angular_program(law, ensemble, name_of_tuple(each));
  auto const& kernels = for_instruction_set(
      [](auto set) -> TupleFormulaKernels const& { return tuple_formula_kernels<decltype(set)::value>(); });
  for (auto* part : {&program.influence, &program.measure}) part->code = machine_code(*part, kernels.code_width);
  add_tuples(ensemble, each, std::move(members),
             each == 3 ? kernels.angles[ensemble.dimension() == 2 ? 0 : 1] : kernels.dihedrals,
             LawPointer(std::make_shared<AngularProgram const>(std::move(program))), false);
}

void MoleculeScheme::angles(AnyEnsemble& ensemble, std::vector<AngleMembers> const& angles, FormulaLaw const& law) {
  add_tuples(ensemble, 3, flat(angles), law);
}
void MoleculeScheme::dihedrals(AnyEnsemble& ensemble, std::vector<DihedralMembers> const& dihedrals,
                               FormulaLaw const& law) {
  add_tuples(ensemble, 4, flat(dihedrals), law);
}

void MoleculeScheme::keeps(std::shared_ptr<RigidBonds const> bonds) {
  add(bonds->ensemble());
  rigid_.push_back(std::move(bonds));
  changed();
}

std::string MoleculeScheme::shear_refused() const {
  return rigid_.empty() ? "" : "is kept rigid with no regard to the velocities of images that flow; use springs";
}

void MoleculeScheme::add_influences(double) {
  for (auto const& group : groups_) {
    if (division_ && !division_->brings(*group->ensemble)) division_->make_whole();
    group->add_influences(box(), quantum_, division_, threads());
  }
}

/// Rows of remote members arrive with those of neighbours, if there are lists.
void MoleculeScheme::divide(Division* division) {
  division_ = division;
  if (!division) return;
  division->also_read([this](Division::Add const& add) {
    for (auto const& group : groups_) {
      group->find_own(*division_);
      for (auto const i : group->own_members) add(*group->ensemble, i);
    }
  });
}

std::optional<std::uint64_t> MoleculeScheme::revision() const {
  if (std::any_of(groups_.begin(), groups_.end(), [](auto const& group) { return group->reads_outside; }))
    return std::nullopt;
  return revision_with({});
}

/// Each member has an equal share of its tuple's energy and virial. Every rank measures all tuples, after an exchange
/// of all rows.
EnergyAndVirial MoleculeScheme::measure(double) {
  if (division_) division_->make_whole();
  auto measures = EnergyAndVirial::known();
  measures.reciprocal = true;
  auto const& all = ensembles();
  for (auto const* ensemble : all) {
    measures.per_particle.emplace_back(ensemble->size());
    measures.virial_per_particle.emplace_back(9 * ensemble->size());
  }
  ExactSum potential;
  std::array<ExactSum, 9> virials;
  for (auto const& group : groups_) {
    TupleTask task = group->task(box());
    std::vector<double> energy(group->count()), virial(9 * group->count());
    task.energy = energy.data();
    task.virial = virial.data();
    for_ranges(group->count(), tuples_grain, threads_for(group->count(), tuple_work, threads()),
               [&](std::size_t begin, std::size_t end) { group->kernels.measure(group->law.get(), task, begin, end); });
    auto const e = static_cast<std::size_t>(std::find(all.begin(), all.end(), group->ensemble) - all.begin());
    double const share = 1 / static_cast<double>(group->each);
    potential.add(energy);
    add_columns(virials, virial, threads());
    for (std::size_t t = 0; t < group->count(); ++t)
      for (std::size_t m = 0; m < group->each; ++m) {
        std::size_t const i = group->members[t * group->each + m];
        measures.per_particle[e][i] += share * energy[t];
        for (std::size_t k = 0; k < 9; ++k) measures.virial_per_particle[e][9 * i + k] += share * virial[9 * t + k];
      }
  }
  for (auto const& bonds : rigid_) {
    auto const e = static_cast<std::size_t>(std::find(all.begin(), all.end(), &bonds->ensemble()) - all.begin());
    std::vector<double> virial(9 * bonds->ensemble().size());
    bonds->add_virial(virial);
    add_columns(virials, virial, threads());
    for (std::size_t k = 0; k < virial.size(); ++k) measures.virial_per_particle[e][k] += virial[k];
  }
  measures.potential = potential.value();
  for (std::size_t k = 0; k < 9; ++k) measures.virial[k / 3][k % 3] = virials[k].value();
  return measures;
}

/// Coincident neighbours in a tuple have no angle, whichever of its members was given.
std::string MoleculeScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const {
  for (auto const& group : groups_) {
    if (group->ensemble != &ensemble) continue;
    auto const& members = group->members;
    for (std::size_t first = 0; first < members.size(); first += group->each) {
      auto const begin = members.begin() + static_cast<std::ptrdiff_t>(first),
                 end = begin + static_cast<std::ptrdiff_t>(group->each);
      if (std::find(begin, end, i) == end) continue;
      for (auto at = begin; at + 1 != end; ++at) {
        double d[3] = {0, 0, 0};
        for (int a = 0; a < ensemble.dimension(); ++a) d[a] = ensemble.row(at[1])[a] - ensemble.row(at[0])[a];
        box().nearest_image(d);
        if (d[0] == 0 && d[1] == 0 && d[2] == 0)
          return fmt::format("{} {} of '{}' is not defined: its particles {} and {} are at the same place",
                             name_of_tuple(group->each), first / group->each, ensemble.name(), at[0], at[1]);
      }
    }
  }
  return at_one_place(ensemble, i);
}

std::size_t MoleculeScheme::bytes() const {
  std::size_t bytes = 0;
  for (auto const& group : groups_)
    bytes += (group->members.capacity() + group->slot.capacity()) * sizeof(std::uint32_t) +
             group->start.capacity() * sizeof(std::size_t) + group->forces.capacity() * sizeof(double);
  return bytes;
}

std::string MoleculeScheme::summary() const {
  std::size_t angles = 0, dihedrals = 0;
  for (auto const& group : groups_) (group->each == 3 ? angles : dihedrals) += group->count();
  std::string text = "molecules";
  if (angles > 0) text += fmt::format(" of {} angles", angles);
  if (dihedrals > 0) text += fmt::format("{} {} dihedrals", angles > 0 ? " and" : " of", dihedrals);
  std::size_t rigid = 0;
  for (auto const& bonds : rigid_) rigid += bonds->size();
  if (rigid > 0) text += fmt::format("{} {} rigid bonds", angles + dihedrals > 0 ? " and" : " of", rigid);
  return text;
}

void MoleculeScheme::restore(std::span<double const> state) {
  if (state.size() != 1) throw Error("the checkpoint has nothing about this simulation's molecules");
  quantum_ = state[0];
}

}  // namespace boltzmann
