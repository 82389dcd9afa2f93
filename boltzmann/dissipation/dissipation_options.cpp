// The members of friction and noise with their keys.
#include <boltzmann/core/once.hpp>
#include <boltzmann/dissipation/dissipation_options.hpp>

namespace boltzmann {
namespace {

using namespace option;

/// Dissipation times temperature: the flux between two particles is kappa (1/Ti - 1/Tj).
constexpr Dimension conduction = dimensions::energy * dimensions::temperature / dimensions::time;

OptionTable make_dissipation_options() {
  using D = DissipationOptions;
  OptionTable all;
  all.add("convention", &D::dissipation, &DissipationLaw::convention, convention_words(),
          "relation between friction and noise");
  all.add("friction", &D::dissipation, &DissipationLaw::friction, number(dimensions::friction, not_negative),
          "friction gamma; 0: none. Or a formula, in quotes, of `r` and, with `\"constant-friction\"`, of `T`");
  all.add(
      "temperature", &D::dissipation, &DissipationLaw::temperature, number(dimensions::temperature, positive),
      "temperature of the heat bath (`\"fixed-temperature\"`) or of the convention; not for `\"constant-friction\"`",
      "needed, except with `\"constant-friction\"`");
  all.add("range", &D::dissipation, &DissipationLaw::range, number(dimensions::length, positive),
          "range of the interaction, at most half of a periodic axis");
  all.add("exponent", &D::dissipation, &DissipationLaw::exponent, number(dimensions::none, not_negative),
          "exponent of chi");
  all.add_said("weight", text("a [formula](../../how-to/write-a-formula-law.md) of `r` and `range`, zero or more"),
               "chi, instead of `exponent`: `\"(1 - r/range)^2*(1 + 2*r/range)\"`", "from `exponent`");
  all.add_said("parameters", "a table of quantities", "constants of the formulas: `{ length = \"4 angstrom\" }`",
               "none");
  all.add("projected", &D::dissipation, &DissipationLaw::projected, flag(),
          "act along the line of centres, which conserves angular momentum; else in all directions");
  all.add("conduction", &D::dissipation, &DissipationLaw::conduction, number(conduction, not_negative),
          "heat conduction kappa chi^2 (1/Ti - 1/Tj) between internal energies");
  all.add("method", &D::method, dissipation_method_words(),
          "all pairs at once, or one after the other (Shardlow), which is slower but right for any friction");
  all.add("corrector", &D::corrector, flag(),
          "second order in friction times step, for twice the work; three times with internal energies");
  all.add("metropolis", &D::metropolis, flag(),
          "with shardlow: accept or reject new velocities of pairs, for exact equilibrium");
  all.at("convention").needed = "\"constant-friction\"";
  all.at("friction").needed = "\"1e-14 kg/s\"";
  all.at("range").needed = "\"15 angstrom\"";
  return all;
}

OptionTable make_bath_options() {
  OptionTable all;
  all.add("temperature", &BathOptions::temperature, number(dimensions::temperature, not_negative),
          "temperature of the heat bath; or a formula of the `time`, in quotes");
  all.add("rate", &BathOptions::rate, number(dimensions::frequency, positive), "relaxation rate of the velocities");
  all.at("temperature").needed = "\"300 K\"";
  all.at("rate").needed = "\"5 1/ps\"";
  all.add("low", &BathOptions::low, vector(dimensions::length),
          "with `high`: acts only on particles in this block at the time", "everywhere");
  all.add("high", &BathOptions::high, vector(dimensions::length), "its upper edges", "everywhere");
  return all;
}

OptionTable make_rescaling_options() {
  return bath_options().only({{"temperature"}, {"rate", "relaxation rate of the kinetic energy"}, {"low"}, {"high"}});
}

OptionTable make_equilibration_bath_options() { return bath_options().only({{"temperature"}, {"rate"}}); }

OptionTable make_chain_options() {
  OptionTable all = bath_options().only(
      {{"temperature", "temperature of the heat bath, above zero; or a formula of the `time`, in quotes"},
       {"rate",
        "about the rate of the motion to control; the masses of the chain are f k T / rate^2 and k T / rate^2"}});
  all.add("chain", &BathOptions::chain, whole(1, 100), "length of the chain");
  return all;
}

}  // namespace

OptionTable const& dissipation_options() { return once<make_dissipation_options>(); }
OptionTable const& bath_options() { return once<make_bath_options>(); }
OptionTable const& equilibration_bath_options() { return once<make_equilibration_bath_options>(); }

std::vector<DissipationKind> const& dissipation_kinds() {
  static std::vector<DissipationKind> const all = {
      {"dpd",
       "friction, noise and heat exchange between near particles: DPD, or DPDE with internal energies. Conserves "
       "momentum",
       "dp = -friction chi^2 v dt + noise chi dW, chi = (1 - r / range)^exponent or a formula, v the relative velocity",
       dissipation_options()},
      {"langevin", "a heat bath on each particle", "dv = -rate v dt + (2 rate k temperature / m)^(1/2) dW",
       bath_options()},
      {"velocity-rescaling",
       "a canonical heat bath on the total kinetic energy (Bussi, Donadio and Parrinello); keeps momenta and hardly "
       "disturbs the motion",
       "dK = rate (f k temperature / 2 - K) dt + (2 K rate k temperature)^(1/2) dW", once<make_rescaling_options>()},
      {"nose-hoover",
       "a chain of Nose and Hoover on all particles together (Martyna, Klein and Tuckerman), without noise",
       "dv = -u v dt, du = rate^2 (2 K / (f k temperature) - 1) dt, with the chain acting on u",
       once<make_chain_options>()}};
  return all;
}

}  // namespace boltzmann
