// bzm completion: what a shell needs to complete bzm's commands, options, scenarios and files.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/error.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace boltzmann::bzm {

int completion(std::string const& shell, std::vector<CommandWords> const& commands) {
  if (shell != "bash") throw Error("there is a completion for bash only, not for '" + shell + "'");
  std::string names, cases;
  for (auto const& command : commands) {
    names += command.name + " ";
    std::string options;
    for (auto const& option : command.options) options += (options.empty() ? "" : " ") + option;
    cases += fmt::format("    {}) options='{}' ;;\n", command.name, options);
  }
  std::string script = R"bash(# Completion of bzm for bash: eval "$(bzm completion bash)"
_bzm() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} options=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W '@names--help --version' -- "$word"))
    return
  fi
  case $command in
@cases  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
    return
  fi
  case $command in
    run | check)
      COMPREPLY=($(compgen -W "$(bzm list --names scenarios 2>/dev/null)" -- "$word")
        $(compgen -f -X '!*.toml' -- "$word") $(compgen -d -- "$word")) ;;
    show) COMPREPLY=($(compgen -W "$(bzm list --names 2>/dev/null)" -- "$word")) ;;
    resume | render | doctor) COMPREPLY=($(compgen -d -- "$word")) ;;
    bench) COMPREPLY=($(compgen -f -- "$word")) ;;
    build) COMPREPLY=($(compgen -f -X '!*.cpp' -- "$word") $(compgen -d -- "$word")) ;;
    completion) COMPREPLY=($(compgen -W bash -- "$word")) ;;
  esac
}
complete -o filenames -F _bzm bzm
)bash";
  script.replace(script.find("@names"), 6, names);
  script.replace(script.find("@cases"), 6, cases);
  std::fputs(script.c_str(), stdout);
  return 0;
}

}  // namespace boltzmann::bzm
