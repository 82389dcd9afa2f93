// One look of a diagnosis at particles as they are.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <vector>

namespace boltzmann::test {

/// Its row.
inline std::vector<double> look(Diagnosis& diagnosis, std::vector<AnyEnsemble*> const& ensembles, Box const& box,
                                int threads = 1) {
  Sample sample{ensembles, box, nullptr, 1, 0, 0};
  sample.threads = threads;
  std::vector<double> values;
  diagnosis.measure(sample, values);
  return values;
}

}  // namespace boltzmann::test
