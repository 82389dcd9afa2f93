// Laws given as formulas in a pair scheme: combines their programs with the kernels of the selected instruction set.
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/formulas/machine_code.hpp>
#include <boltzmann/schemes/pair/formula_kernels.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/pair/rate_kernels.hpp>

namespace boltzmann {
namespace {

std::size_t index_of_dimension(AnyEnsemble const& ensemble) {
  return static_cast<std::size_t>(ensemble.dimension() - 1);
}

FormulaKernelTable const& kernels() {
  return for_instruction_set(
      [](auto set) -> FormulaKernelTable const& { return formula_kernels<decltype(set)::value>(); });
}

/// Compiles to machine code if it is compatible with the kernels in use.
std::shared_ptr<PairProgram const> ready(PairProgram program, int dimension) {
  int const width = kernels().code_width;
  program.influence.code = machine_code(program.influence, width,
                                        GatheredColumns{dimension, program.of_q, program.along, program.least_square});
  program.measure.code = machine_code(program.measure, width);
  return std::make_shared<PairProgram const>(std::move(program));
}
std::shared_ptr<ExternalProgram const> ready(ExternalProgram program) {
  for (auto* part : {&program.influence, &program.measure}) part->code = machine_code(*part, kernels().code_width);
  return std::make_shared<ExternalProgram const>(std::move(program));
}
std::shared_ptr<RateProgram const> ready(RateProgram program) {
  program.program.code = machine_code(program.program, kernels().code_width);
  return std::make_shared<RateProgram const>(std::move(program));
}

/// The driven field that a law changes; -1: it moves particles.
int field_changed(FormulaLaw const& law, AnyEnsemble const& target) {
  return law.changes.empty() ? -1 : target.number_driven(target.field(law.changes));
}

struct ReadyPairs {
  PairKernels kernels;
  PairScheme::LawPointer law;
  PairScheme::LawTraits traits;

  ReadyPairs(PairProgram program, FormulaLaw const& of, AnyEnsemble const& target)
      : kernels(boltzmann::kernels().pairs[index_of_dimension(target)]) {
    kernels.has_energy = program.has_energy;
    traits.velocity_dependent = program.velocity_dependent;
    traits.positions_alone = program.of_p.empty() && program.of_q.empty();
    traits.one_way = !program.antisymmetric;
    traits.changes = field_changed(of, target);
    // rates may end at the cut-off discontinuously, as those of neighbours do
    if (traits.moves()) traits.typed = program.numbers;
    law = ready(std::move(program), target.dimension());
  }
};

}  // namespace

void PairScheme::one_way(AnyEnsemble& target, AnyEnsemble& source, FormulaLaw const& law, double cutoff) {
  ReadyPairs const ready(law.between(target, source, FormulaLaw::Target::p, cutoff), law, target);
  add_pairs(target, source, ready.kernels, ready.law, ready.traits, cutoff);
}

void PairScheme::internal(AnyEnsemble& ensemble, FormulaLaw const& law, double cutoff) {
  one_way(ensemble, ensemble, law, cutoff);
}

void PairScheme::between(AnyEnsemble& a, AnyEnsemble& b, FormulaLaw const& law, double cutoff) {
  // An energy belongs to both particles; an influence is that of q on p, for either order.
  auto const part = law.gives == FormulaLaw::Gives::energy ? FormulaLaw::Target::q : FormulaLaw::Target::p;
  ReadyPairs const on_a(law.between(a, b, FormulaLaw::Target::p, cutoff), law, a),
      on_b(law.between(b, a, part, cutoff), law, b);
  add_pairs(a, b, on_a.kernels, on_a.law, on_a.traits, cutoff);
  add_pairs(b, a, on_b.kernels, on_b.law, on_b.traits, cutoff);
}

void PairScheme::connect(AnyEnsemble& ensemble, std::vector<Connection> const& connections, FormulaLaw const& law) {
  ReadyPairs const ready(law.between(ensemble, ensemble), law, ensemble);
  add_connections(ensemble, connections, ready.kernels, ready.law, ready.traits);
}

void PairScheme::external(AnyEnsemble& ensemble, FormulaLaw const& law, std::vector<std::uint32_t> const* only) {
  ExternalProgram program = law.on(ensemble);
  ExternalKernels kernels = boltzmann::kernels().externals[index_of_dimension(ensemble)];
  kernels.has_energy = program.has_energy;
  kernels.depends_on_time = program.depends_on_time;
  LawTraits traits;
  traits.velocity_dependent = program.velocity_dependent;
  traits.changes = field_changed(law, ensemble);
  add_external(ensemble, kernels, ready(std::move(program)), traits, only);
}

void PairScheme::rates(AnyEnsemble& ensemble, FieldRates const& rates) {
  RateProgram program = rates.on(ensemble);
  auto const& table =
      for_instruction_set([](auto set) -> RateKernelTable const& { return rate_kernels<decltype(set)::value>(); });
  ExternalKernels kernels;
  kernels.influence = table.rates[index_of_dimension(ensemble)];
  kernels.depends_on_time = program.depends_on_time;
  LawTraits traits;
  traits.velocity_dependent = program.velocity_dependent;
  traits.changes = 0;
  traits.rates = true;
  add_external(ensemble, kernels, ready(std::move(program)), traits, nullptr);
}

}  // namespace boltzmann
