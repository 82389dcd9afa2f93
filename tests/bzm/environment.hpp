// Words in the environment of the programs that a test starts, as long as this lives.
#pragma once

#include <cstdlib>
#include <map>
#include <optional>
#include <string>

namespace boltzmann::test {

class Environment {
 public:
  ~Environment() {
    for (auto const& [name, value] : before_)
      if (value)
        setenv(name.c_str(), value->c_str(), 1);
      else
        unsetenv(name.c_str());
  }
  /// Empty: it goes.
  void set(std::string const& name, std::string const& value) {
    char const* const now = std::getenv(name.c_str());
    before_.try_emplace(name, now ? std::optional<std::string>(now) : std::nullopt);
    if (value.empty())
      unsetenv(name.c_str());
    else
      setenv(name.c_str(), value.c_str(), 1);
  }

 private:
  std::map<std::string, std::optional<std::string>> before_;
};

}  // namespace boltzmann::test
