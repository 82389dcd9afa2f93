// Keys for the law and for the ensembles on which it acts.
#include <boltzmann/schemes/field_options.hpp>

namespace boltzmann {

void add_field_keys(OptionTable& all) {
  all.add_said("law", option::text("coulomb with `k`, or gravity with `G`"), "source of the field");
  all.add_said("k", "constant of the law", "of `law = \"coulomb\"`", "that of nature");
  all.add_said("G", "constant of the law", "of `law = \"gravity\"`", "that of nature");
  all.add_said("on", option::ensembles(), "ensembles that make and feel the field; any mass makes gravity",
               "`Coulomb` for `\"coulomb\"`, `Kepler` for `\"gravity\"`");
  all.at("law").needed = "\"coulomb\"";
}

}  // namespace boltzmann
