// Keys of embedded atoms and of atoms with bonds.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/embedding_table.hpp>
#include <boltzmann/schemes/many_body/many_body_options.hpp>

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace boltzmann {

Words<MetalPotential> const& metal_potential_words() {
  static Words<MetalPotential> const all{
      "potential",
      {{MetalPotential::sutton_chen, "sutton-chen",
        "V = epsilon (a/r)^n, rho = (a/r)^m, F = -c epsilon sqrt(rho) (Sutton and Chen 1990)"},
       {MetalPotential::gupta, "gupta",
        "V = 2 A exp(-p (r/r0 - 1)), rho = xi^2 exp(-2 q (r/r0 - 1)), F = -sqrt(rho) (Cleri and Rosato 1993)"},
       {MetalPotential::formulas, "formulas", "V, rho and F as formulas"},
       {MetalPotential::file, "file", "tables of a file: setfl (eam.alloy, eam.fs) or funcfl"}}};
  return all;
}

OptionTable const& embedded_atom_options() {  // long: a table, a row for each key
  using namespace option;
  using E = EmbeddedAtomOptions;
  static OptionTable const all = [] {
    OptionTable all;
    auto const add = [&](char const* key, auto of, auto member, Dimension dimension, char const* doc,
                         char const* example) {
      all.add(key, of, member, number(dimension, positive), doc);
      all.at(key).needed = example;
    };
    all.add("potential", &E::potential, metal_potential_words(),
            "energies of pairs, densities and embedding: Sutton and Chen, Gupta, formulas or a file");
    all.at("potential").needed = "\"sutton-chen\"";
    all.add_said("on", ensembles(), "the atoms", "all moved by forces");
    all.add_said("elements", "a table, { atoms = \"Cu\" }", "element of each ensemble, for a file with several",
                 "the ensemble's name");
    all.add("file", &E::file, path(),
            "`\"file\"`: path, relative to the scenario; tables in eV and angstrom: setfl (eam.alloy, eam.fs) or "
            "funcfl, also compressed by gzip");
    all.at("file").needed = "\"Cu.eam.alloy\"";
    add("epsilon", &E::sutton_chen, &SuttonChen::epsilon, dimensions::energy,
        "`\"sutton-chen\"`: epsilon, the energy of a pair at distance a", "\"12.382 meV\"");
    add("a", &E::sutton_chen, &SuttonChen::a, dimensions::length, "`\"sutton-chen\"`: lattice constant a",
        "\"3.61 angstrom\"");
    add("n", &E::sutton_chen, &SuttonChen::n, dimensions::none, "`\"sutton-chen\"`: exponent n of pair energies", "9");
    add("m", &E::sutton_chen, &SuttonChen::m, dimensions::none, "`\"sutton-chen\"`: exponent m of densities", "6");
    add("c", &E::sutton_chen, &SuttonChen::c, dimensions::none, "`\"sutton-chen\"`: strength c of the embedding",
        "39.432");
    add("A", &E::gupta, &Gupta::A, dimensions::energy, "`\"gupta\"`: half the energy of a pair at r0", "\"85.5 meV\"");
    add("xi", &E::gupta, &Gupta::xi, dimensions::energy, "`\"gupta\"`: square root of the density at r0",
        "\"1.224 eV\"");
    add("p", &E::gupta, &Gupta::p, dimensions::none, "`\"gupta\"`: decay p of pair energies", "10.96");
    add("q", &E::gupta, &Gupta::q, dimensions::none, "`\"gupta\"`: decay q of the square roots of densities", "2.278");
    add("r0", &E::gupta, &Gupta::r0, dimensions::length, "`\"gupta\"`: distance of neighbours", "\"2.556 angstrom\"");
    all.add_said("pair", text("a formula of r"), "`\"formulas\"`: energy V of a pair");
    all.add_said("density", text("a formula of r"), "`\"formulas\"`: density rho of an atom, a pure number");
    all.add_said("embedding", text("a formula of rho"), "`\"formulas\"`: energy F of an atom in a density");
    all.add_said("parameters", "a table, { xi = \"1.2 eV\" }", "`\"formulas\"`: constants", "none");
    all.at("pair").needed = "\"A*exp(-p*(r/r0 - 1))\"";
    all.at("density").needed = "\"exp(-2*q*(r/r0 - 1))\"";
    all.at("embedding").needed = "\"-xi*sqrt(rho)\"";
    all.add("cutoff", &E::cutoff, number(dimensions::length, positive),
            "cut-off of pair energies and densities; a file has its own");
    all.at("cutoff").needed = "\"7.2 angstrom\"";
    all.add("switch_from", &E::from, number(dimensions::length, positive),
            "start of the smooth step, with three continuous derivatives, that ends at the cut-off",
            "0.9 of the cut-off");
    all.add("skin", &E::skin, number(dimensions::length, not_negative), "reach of neighbour lists beyond the cut-off",
            "0.12 of the cut-off");
    return all;
  }();
  return all;
}

OptionTable embedded_atom_options(MetalPotential potential) {
  std::vector<OptionKey> keys{{"potential"}, {"on"}};
  auto const add = [&](std::initializer_list<char const*> more) {
    for (char const* key : more) keys.push_back({key});
  };
  if (potential == MetalPotential::sutton_chen) add({"epsilon", "a", "n", "m", "c", "cutoff", "switch_from"});
  if (potential == MetalPotential::gupta) add({"A", "xi", "p", "q", "r0", "cutoff", "switch_from"});
  if (potential == MetalPotential::formulas)
    add({"pair", "density", "embedding", "parameters", "cutoff", "switch_from"});
  if (potential == MetalPotential::file) add({"elements", "file"});
  add({"skin"});
  return embedded_atom_options().only(keys);
}

EmbeddedAtoms embedded_atoms(EmbeddedAtomOptions const& options, UnitSystem const& units) {
  if (options.potential == MetalPotential::file) return EmbeddedAtoms::from_file(options.file, units);
  EmbeddedReach reach{options.cutoff};
  if (options.from) reach.switch_from = *options.from;
  if (options.potential == MetalPotential::gupta) return {options.gupta, reach};
  if (options.potential == MetalPotential::formulas) {
    // Above all densities except in hard collisions.
    double const greatest = 500 * options.density(options.cutoff / 3);
    if (!(greatest > 0) || !std::isfinite(greatest))
      throw Error(fmt::format("density: {:.6g} at a third of the cut-off; it must be positive there",
                              options.density(options.cutoff / 3)));
    return EmbeddedAtoms(
        {{"", std::make_shared<EmbeddingTable>(options.embedding, greatest)}},
        [&](std::size_t, std::size_t, double r) { return options.pair(r); },
        [&](std::size_t, std::size_t, double r) { return options.density(r); }, reach);
  }
  return {options.sutton_chen, reach};
}

OptionTable const& stillinger_weber_options() {
  using namespace option;
  using S = StillingerWeberOptions;
  static OptionTable const all = [] {
    OptionTable all;
    auto const add = [&](char const* key, auto member, OptionKind const& kind, char const* doc,
                         char const* otherwise = "") { all.add(key, &S::law, member, kind, doc, otherwise); };
    all.add_said("on", ensembles(), "the atoms", "all moved by forces");
    add("epsilon", &StillingerWeber::epsilon, number(dimensions::energy, positive),
        "depth epsilon of a pair's energy; silicon: `\"2.1683 eV\"`");
    add("sigma", &StillingerWeber::sigma, number(dimensions::length, positive),
        "length sigma, 0.8909 of the distance of neighbours; silicon: `\"2.0951 angstrom\"`");
    all.at("epsilon").needed = "\"2.1683 eV\"";
    all.at("sigma").needed = "\"2.0951 angstrom\"";
    add("A", &StillingerWeber::A, number(dimensions::none, not_negative),
        "pair energy epsilon A (B (sigma/r)^p - (sigma/r)^q) exp(1/(r/sigma - a))");
    add("B", &StillingerWeber::B, number(dimensions::none, not_negative), "factor of the repulsion in it");
    add("p", &StillingerWeber::p, whole(0, 24), "exponent of the repulsion");
    add("q", &StillingerWeber::q, whole(0, 24), "exponent of the attraction");
    add("a", &StillingerWeber::a, number(dimensions::none, positive), "cut-off of pairs and bonds, in sigma");
    add("lambda", &StillingerWeber::lambda, number(dimensions::none, not_negative),
        "strength of angles: lambda epsilon g(r_ij) g(r_ik) (cos theta - cosine)^2, g = exp(gamma/(r/sigma - a))");
    add("gamma", &StillingerWeber::gamma, number(dimensions::none, positive), "range of g");
    add("cosine", &StillingerWeber::cosine, number(dimensions::none, {-1, 1, false}),
        "cosine of the angle without energy", "-1/3, the tetrahedral angle");
    all.add("skin", &S::skin, number(dimensions::length, not_negative), "reach of neighbour lists beyond the cut-off",
            "0.12 of the cut-off");
    return all;
  }();
  return all;
}

}  // namespace boltzmann
