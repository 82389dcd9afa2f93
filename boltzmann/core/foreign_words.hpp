// Terms of other programs that are not one word of Boltzmann: the counterpart in Boltzmann, or that there is none.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace boltzmann {

struct ForeignTerm {
  std::string_view words;   ///< in small letters, separated by |
  std::string_view answer;  ///< a clause that follows a semicolon
};

/// Programs: LAMMPS, GROMACS, HOOMD-blue, OpenMM, REBOUND, PySPH, WarpX.
inline constexpr std::array foreign_terms{
    // ---- actions between the steps ----
    ForeignTerm{"thermostat|thermostats|heat_bath|temp/berendsen|temp/csvr|temp/csld|temp/rescale|tcoupl|tau_t|ref_t|"
                "constantvolume|langevinintegrator|mttk|bussi",
                "a thermostat is a table of its own: [[dissipation]] with kind = \"nose-hoover\", "
                "\"velocity-rescaling\" or \"langevin\", on, temperature and rate"},
    ForeignTerm{"barostat|barostats|pcoupl|tau_p|ref_p|press/berendsen|npt|nph|constantpressure|montecarlobarostat",
                "a pressure is held by a table of its own: [barostat], beside a [[dissipation]]"},
    ForeignTerm{"integrator|integrators|nve|method",
                "ensembles move by leap-frog (velocity Verlet) unless `integrator` of [[ensembles]] names another; "
                "bzm list integrators"},
    ForeignTerm{"nvt", "constant temperature is a table [[dissipation]], e.g. with kind = \"nose-hoover\""},
    // ---- forces ----
    ForeignTerm{"setforce|fix freeze|freeze_atoms|immobile|static",
                "`freeze` in [[ensembles.set]] keeps particles where they are, and integrator = \"deactivate\" a "
                "whole ensemble"},
    ForeignTerm{"addforce|aveforce|efield|externalforce|customexternalforce|add_force|additional_forces",
                "an external force is a table [[influences]] with law = \"uniform-gravity\", "
                "\"uniform-electric-field\", or a formula with from_outside = true"},
    ForeignTerm{"spring/self|spring/tether|restrain|position_restraints|posres",
                "particles of class Tethered are held at their anchors by law = \"tether\""},
    ForeignTerm{"wall/reflect|wall/lj93|wall/lj126|wall/harmonic|wall/gran|nwall",
                "walls are boundary = \"reflecting\" or \"mirror\" of [box], with [[box.walls]]; a wall with a force "
                "is a formula law with from_outside = true"},
    ForeignTerm{"deform|sllod|nvt/sllod", "a box is sheared by `shear` of [box]"},
    ForeignTerm{"shake|rattle|settle|constraints|lincs|rigid|rigid/small|rigid_body|distance_constraint",
                "bonds of a fixed length are tables [[rigid_bonds]]"},
    ForeignTerm{"deposit|pour|add_particles|inlet|injection", "particles are added by [[events]] with `add`"},
    ForeignTerm{"evaporate|absorbing_boundary", "particles leave where boundary = \"open\""},
    // ---- pair potentials ----
    ForeignTerm{"pair_coeff|pair_modify|special_bonds|force_field|forcefield|nonbonded|nonbondedforce|nlist",
                "a law between particles is a table [[influences]] with law = \"lennard-jones\" or an energy formula"},
    ForeignTerm{"eam|eam/alloy|eam/fs|eam/cd|embedded-atom|embedded_atom",
                "embedded atoms are the table [embedded_atoms], with potential = \"file\" for eam.alloy and eam.fs"},
    ForeignTerm{"sw|stillinger-weber", "bonds with angles between them are the table [stillinger_weber]"},
    ForeignTerm{"buck|buck/coul/long|buckingham|born|mie|mie/cut|yukawa|lj96/cut|lj/expand|wca|lj/charmm/coul/long|"
                "ljwca|force_lj|expanded_lj|zbl|moliere|gauss|gaussian|dpd/conservative|table|tabulated|zhou|beck",
                "it is not built in; write it as a formula: [[influences]] with energy = \"...\", a formula of r, and "
                "parameters = "
                "{ ... }"},
    ForeignTerm{"lj/cut/coul/long|lj/cut/coul/cut|lj/long/coul/long",
                "it is two tables: [[influences]] with law = \"lennard-jones\", and [mesh] with law = \"coulomb\""},
    ForeignTerm{"kspace_style|kspace|pppm/disp|pme_order|fourierspacing|spme",
                "long-range charges are the table [mesh] with law = \"coulomb\" and accuracy = 1e-4"},
    ForeignTerm{"bond_style|bond_coeff|angle_style|dihedral_style|improper_style",
                "bonds are listed by `bonds` of [[ensembles]] and act by [[influences]] with connect = \"bonds\", "
                "angles or dihedrals"},
    ForeignTerm{"tree|treecode|barnes-hut|fmm|gravity_tree", "long sums over a tree are the table [multipole]"},
    // ---- set-up and runs ----
    ForeignTerm{"create_atoms|create_box|region|read_data|include|topology|gro_file",
                "particles are placed by `load` of [[ensembles]]: kind = \"block\", \"random\", \"file\"; bzm list "
                "loaders"},
    ForeignTerm{"velocity create|gen_vel|gen_temp|thermalize_particle_momenta",
                "velocities of a temperature are `temperature` of [[ensembles]]"},
    ForeignTerm{"minimize|min_style|emtol|steep|fire|energy_minimization",
                "energies are minimised by the table [minimise]"},
    ForeignTerm{"neighbor|neigh_modify|nstlist|rlist|r_buff",
                "lists are kept for you; `skin` of [run] is their margin"},
    ForeignTerm{"run_style|respa|r-respa|mts", "slow laws have `every` of [[influences]]"},
    ForeignTerm{"thermo_style|thermo_modify|nstenergy|logger|statedatareporter",
                "measurements are tables [[diagnoses]], written every `diagnoses` steps of [output]"},
    ForeignTerm{"nstxout|nstxtcout|gsd|dcd|dcdreporter|simulationarchive|write_data|write_restart|read_restart",
                "files are keys of [output]: trajectory, checkpoint; bzm export writes other formats"},
    ForeignTerm{"ave/time|ave/chunk|ave/correlate|fix print|variable|compute reduce|compute_reduce",
                "values are tables [[diagnoses]] of kind \"formula\", \"average\" or \"mean-profile\""},
    ForeignTerm{"stress/atom|heat/flux", "the pressure tensor is the diagnosis pressure, heat is heat-flux"},
    // ---- smooth particles and plasmas ----
    ForeignTerm{
        "wcsph|tait|tait-eos|gsph|crksph|tvf|edac|iisph|artificial_viscosity|alpha_av|balsara|cubicspline|"
        "quinticspline|"
        "wendlandquintic|smoothing_length|h_sml|kernel|hdx",
        "a continuum is the table [smooth], with `weight` and `viscosity`, and a `material` in each ensemble of "
        "class Smooth or Solid"},
    ForeignTerm{"cells_per_dimension|n_cell|number_of_cells|particle_shape|shape_factor|deposition|poisson|"
                "electrostatic|multigrid",
                "fields on a mesh are the table [mesh] with cells and assignment"},
    // ---- not available ----
    ForeignTerm{"granular|gran/hooke|gran/hertz|gran/hooke/history|gran/hertz/history|hertz|hooke/history|dem|ligghts",
                "Boltzmann has no granular contacts with friction and history; a formula law can repel and damp"},
    ForeignTerm{"meam|meam/c|tersoff|airebo|rebo|reaxff|reax/c|reax|comb|comb3|bop|edip|adp|snap|mliap|pace|deepmd|"
                "quip|gap|nequip|allegro|mace|gayberne|gay_berne|alj|eff",
                "Boltzmann does not have it; metals are [embedded_atoms], silicon is [stillinger_weber], and laws of "
                "pairs can be formulas"},
    ForeignTerm{
        "maxwell|yee|pml|electromagnetic|fdtd|ckc|laser|antenna|psatd|esirkepov|mcc|ionization|dsmc|"
        "collisions|boosted_frame",
        "Boltzmann does not have it; fields on a mesh are electrostatic, and particles do not collide by chance"},
    ForeignTerm{"whfast|saba|mercurius|trace|wisdom-holman|mercury|leapfrog_symba|eos_rebound",
                "Boltzmann does not have it; integrators for planets are gauss-radau, symplectic-4 and leap-frog; bzm "
                "list integrators"},
    ForeignTerm{"hpmc|monte-carlo|gcmc|atom/swap|widom|metadynamics|plumed|umbrella|free_energy|fep|neb|qeq|polarize|"
                "drude|colvars|lb/fluid|mpcd|srd|qbmm|tad|prd|phonon",
                "Boltzmann does not have it"},
    ForeignTerm{"hard_sphere|hardsphere|collision_resolve|event_driven|edmd",
                "Boltzmann has no hard spheres; a formula law can repel at short distance"},
    ForeignTerm{"group|molecule_template|atom_style|atom_modify|newton|package|suffix|processors|comm_modify",
                "no such thing is needed: kinds of particles are tables [[ensembles]]"}};

/// The counterpart of another program's term in Boltzmann; empty if the term is unknown. A prefix that names its kind
/// ("fix", "compute", "pair_style", "hoomd.md.pair.") is ignored.
std::string foreign_term(std::string_view term);
/// The term in lower case without such a prefix.
std::string without_foreign_kind(std::string_view term);

}  // namespace boltzmann
