// Keys for the law and for the ensembles on which it acts.
#include <boltzmann/schemes/field_options.hpp>

namespace boltzmann {

void add_field_keys(OptionTable& all) {
  all.add_said("law", option::text("coulomb with `k`, or gravity with `G`"), "what the field is made by");
  all.add_said("k", "as of the law", "of `law = \"coulomb\"`", "that of nature");
  all.add_said("G", "as of the law", "of `law = \"gravity\"`", "that of nature");
  all.add_said("on", option::ensembles(), "who makes the field and feels it; gravity is made by the mass of any class",
               "`Coulomb` for `\"coulomb\"`, `Kepler` for `\"gravity\"`");
  all.at("law").needed = "\"coulomb\"";
}

}  // namespace boltzmann
