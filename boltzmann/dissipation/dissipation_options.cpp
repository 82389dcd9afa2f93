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
          "which relation friction and noise obey");
  all.add("friction", &D::dissipation, &DissipationLaw::friction, number(dimensions::friction, not_negative),
          "gamma; 0: none. Or a formula of `r` and, with `\"constant-friction\"`, of `T`, in quotes");
  all.add("temperature", &D::dissipation, &DissipationLaw::temperature, number(dimensions::temperature, positive),
          "of the heat bath (`\"fixed-temperature\"`), or that of the convention; `\"constant-friction\"` has none",
          "needed but for `\"constant-friction\"`");
  all.add("range", &D::dissipation, &DissipationLaw::range, number(dimensions::length, positive),
          "beyond it nothing acts; at most half of a periodic axis");
  all.add("exponent", &D::dissipation, &DissipationLaw::exponent, number(dimensions::none, not_negative), "of chi");
  all.add_said("weight", text("a [formula](#laws-that-are-typed) of `r` and `range`, a number, zero or more"),
               "chi, instead of `exponent`: `\"(1 - r/range)^2*(1 + 2*r/range)\"`", "that of `exponent`");
  all.add_said("parameters", "a table of quantities", "which its formulas use: `{ length = \"4 angstrom\" }`", "none");
  all.add("projected", &D::dissipation, &DissipationLaw::projected, flag(),
          "along the line of centres, so that angular momentum is conserved, too; else in all directions");
  all.add("conduction", &D::dissipation, &DissipationLaw::conduction, number(conduction, not_negative),
          "kappa of the heat that flows between internal energies, kappa chi^2 (1/Ti - 1/Tj)");
  all.add("method", &D::method, dissipation_method_words(),
          "all pairs act at once, or one after the other (Shardlow), which is right for any friction, and slower");
  all.add("corrector", &D::corrector, flag(),
          "simultaneous to second order in friction times step; twice the work, three times where there are internal "
          "energies");
  all.add("metropolis", &D::metropolis, flag(),
          "shardlow accepts or refuses each pair's new velocities, so that the equilibrium is exact");
  all.at("convention").needed = "\"constant-friction\"";
  all.at("friction").needed = "\"1e-14 kg/s\"";
  all.at("range").needed = "\"15 angstrom\"";
  return all;
}

OptionTable make_bath_options() {
  OptionTable all;
  all.add("temperature", &BathOptions::temperature, number(dimensions::temperature, not_negative),
          "of the heat bath; or a formula of the `time` in quotes");
  all.add("rate", &BathOptions::rate, number(dimensions::frequency, positive),
          "velocities forget themselves in 1 / rate");
  all.at("temperature").needed = "\"300 K\"";
  all.at("rate").needed = "\"5 1/ps\"";
  all.add("low", &BathOptions::low, vector(dimensions::length),
          "with `high`: the block of space in which it acts, on those who are there at the time", "everywhere");
  all.add("high", &BathOptions::high, vector(dimensions::length), "its other corner", "everywhere");
  return all;
}

OptionTable make_rescaling_options() {
  return bath_options().only(
      {{"temperature"}, {"rate", "the kinetic energy forgets itself in 1 / rate"}, {"low"}, {"high"}});
}

OptionTable make_equilibration_bath_options() { return bath_options().only({{"temperature"}, {"rate"}}); }

OptionTable make_chain_options() {
  OptionTable all = bath_options().only(
      {{"temperature", "of the heat bath, above zero; or a formula of the `time` in quotes"},
       {"rate",
        "about the rate of the motion that it takes part in: the masses of the chain are f k T / rate^2 and "
        "k T / rate^2"}});
  all.add("chain", &BathOptions::chain, whole(1, 100), "its length");
  return all;
}

}  // namespace

OptionTable const& dissipation_options() { return once<make_dissipation_options>(); }
OptionTable const& bath_options() { return once<make_bath_options>(); }
OptionTable const& equilibration_bath_options() { return once<make_equilibration_bath_options>(); }

std::vector<DissipationKind> const& dissipation_kinds() {
  static std::vector<DissipationKind> const all = {
      {"dpd",
       "friction, noise and heat between near particles, which keep the total momentum: DPD, and DPDE with internal "
       "energies",
       "dp = -friction chi^2 v dt + noise chi dW, chi = (1 - r / range)^exponent or a formula, v the relative velocity",
       dissipation_options()},
      {"langevin", "a heat bath on each particle", "dv = -rate v dt + (2 rate k temperature / m)^(1/2) dW",
       bath_options()},
      {"velocity-rescaling",
       "a heat bath on the kinetic energy of all particles together, canonical (Bussi, Donadio and Parrinello), which "
       "keeps momenta and hardly disturbs the motion",
       "dK = rate (f k temperature / 2 - K) dt + (2 K rate k temperature)^(1/2) dW", once<make_rescaling_options>()},
      {"nose-hoover", "a chain of Nose and Hoover on all particles together (Martyna, Klein and Tuckerman), no noise",
       "dv = -u v dt, du = rate^2 (2 K / (f k temperature) - 1) dt, and the chain behind u",
       once<make_chain_options>()}};
  return all;
}

}  // namespace boltzmann
