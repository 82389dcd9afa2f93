// bzm completion: what a shell needs to complete bzm's commands, options, scenarios and files. Commands and options
// come from the parser; this file only has the syntax of each shell.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/scenario/catalogue_pages.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace boltzmann::bzm {
namespace {

/// A kind of positional argument, and how each shell completes it.
struct Argument {
  char const* name;  ///< the name in the parser
  char const *bash, *zsh, *fish;
};
constexpr Argument arguments[] = {
    {"scenario",
     R"-(
      $(compgen -W "$(bzm list --names scenarios 2>/dev/null)" -- "$word")
      $(compgen -f -X '!*.toml' -- "$word") $(compgen -d -- "$word"))-",
     "_bzm_scenarios", "(bzm list --names scenarios 2>/dev/null; __fish_complete_suffix .toml)"},
    {"folder", R"-($(compgen -d -- "$word"))-", "_files -/", "(__fish_complete_directories)"},
    {"program", R"-($(compgen -f -X '!*.cpp' -- "$word") $(compgen -d -- "$word"))-", R"-(_files -g "*.cpp")-",
     "(__fish_complete_suffix .cpp)"},
    {"name", R"-($(compgen -W "$(bzm list --names 2>/dev/null)" -- "$word"))-", "_bzm_names",
     "(bzm list --names 2>/dev/null)"},
    {"kind", R"-($(compgen -W '@kinds' -- "$word"))-", "(@kinds)", "@kinds"},
    {"shell", R"-($(compgen -W '@shells' -- "$word"))-", "(@shells)", "@shells"}};

std::string replaced(std::string text, std::string const& what, std::string const& with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
    text.replace(at, what.size(), with);
  return text;
}

std::string spaced(std::vector<std::string> const& words) { return join(words, " "); }

/// The completion code of `shell` for the command's argument; "" if there is nothing to complete.
std::string argument(CommandWords const& command, char const* Argument::*shell) {
  if (command.name == "new") return "";  // a name of the user's own
  for (auto const& each : arguments)
    if (each.name == command.argument)
      return replaced(replaced(each.*shell, "@kinds", spaced(listed_kinds())), "@shells", spaced(completion_shells()));
  return "";
}

std::vector<std::string> options_of(CommandWords const& command, char const* value = nullptr) {
  std::vector<std::string> names;
  for (auto const& option : command.options)
    if (!value || option.value == value) names.push_back(option.name);
  return names;
}

std::string bash(std::vector<CommandWords> const& commands) {
  std::string names, cases, words, files;
  for (auto const& command : commands) {
    names += command.name + " ";
    cases += fmt::format("    {}) options='{}' ;;\n", command.name, spaced(options_of(command)));
    if (auto const how = argument(command, &Argument::bash); !how.empty())
      words += fmt::format("    {}) COMPREPLY=({}) ;;\n", command.name, how);
    for (auto const& [value, flag] : {std::pair("DIR", "d"), std::pair("FILE", "f")})
      for (auto const& name : options_of(command, value))
        files +=
            fmt::format("    {}\\ {}) COMPREPLY=($(compgen -{} -- \"$word\")); return ;;\n", command.name, name, flag);
  }
  constexpr char const* script = R"bash(# Completion of bzm for bash: eval "$(bzm completion bash)"
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
  case $command\ ${COMP_WORDS[COMP_CWORD - 1]} in
@files  esac
  case $command in
@words  esac
}
complete -o filenames -F _bzm bzm
)bash";
  return replaced(replaced(replaced(replaced(script, "@names", names), "@cases", cases), "@files", files), "@words",
                  words);
}

// Escapes a text for zsh: within single quotes and lists, where brackets and colons are special.
std::string for_zsh(std::string text) {
  for (auto const* mark : {"\\", "[", "]", ":"}) text = replaced(text, mark, std::string("\\") + mark);
  return replaced(text, "'", "'\\''");
}

std::string zsh(std::vector<CommandWords> const& commands) {
  std::string names, cases;
  for (auto const& command : commands) {
    names += fmt::format("    '{}:{}'\n", command.name, for_zsh(command.doc));
    cases += fmt::format("    {})\n      _arguments", command.name);
    for (auto const& option : command.options) {
      cases += fmt::format(" \\\n        '{}{}{}[{}]",
                           option.value == "KEY=VALUE" || option.value == "KEY=[VALUES]" ? "*" : "", option.name,
                           option.value.empty() ? "" : "=", for_zsh(option.doc));
      if (!option.value.empty())
        cases += fmt::format(":{}:{}", for_zsh(option.value),
                             option.value == "DIR"    ? "_files -/"
                             : option.value == "FILE" ? "_files"
                                                      : "");
      cases += "'";
    }
    if (auto const how = argument(command, &Argument::zsh); !how.empty())
      cases += fmt::format(" \\\n        '1:{}:{}'", command.argument, how);
    cases += " ;;\n";
  }
  constexpr char const* script = R"zsh(#compdef bzm
# Completion of bzm for zsh: eval "$(bzm completion zsh)", or this text as the file _bzm in a folder of $fpath
_bzm_scenarios() {
  local -a names
  names=(${(f)"$(bzm list --names scenarios 2>/dev/null)"})
  _alternative 'scenarios:scenario:compadd -a names' 'files:file:_files -g "*.toml"'
}
_bzm_names() {
  local -a names
  names=(${(f)"$(bzm list --names 2>/dev/null)"})
  compadd -a names
}
_bzm() {
  local -a commands
  commands=(
@names  )
  if (( CURRENT == 2 )); then
    _describe -t commands command commands
    compadd -- --help --version
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
@cases  esac
}
if [ "$funcstack[1]" = _bzm ]; then _bzm "$@"; else compdef _bzm bzm; fi
)zsh";
  return replaced(replaced(script, "@names", names), "@cases", cases);
}

std::string for_fish(std::string const& text) { return replaced(replaced(text, "\\", "\\\\"), "'", "\\'"); }

std::string fish(std::vector<CommandWords> const& commands) {
  std::string script =
      "# Completion of bzm for fish: bzm completion fish | source\ncomplete -c bzm -f\ncomplete -c bzm -n "
      "__fish_use_subcommand -l help -d 'Show this help'\ncomplete -c bzm -n __fish_use_subcommand -l version -d 'Show "
      "the version'\n";
  for (auto const& command : commands) {
    script +=
        fmt::format("complete -c bzm -n __fish_use_subcommand -a {} -d '{}'\n", command.name, for_fish(command.doc));
    std::string const start = fmt::format("complete -c bzm -n '__fish_seen_subcommand_from {}'", command.name);
    if (auto const how = argument(command, &Argument::fish); !how.empty())
      script += fmt::format("{} -a '{}'\n", start, for_fish(how));
    for (auto const& option : command.options)
      script += fmt::format("{} -l {}{} -d '{}'\n", start, option.name.substr(2),
                            option.value.empty()     ? ""
                            : option.value == "DIR"  ? " -x -a '(__fish_complete_directories)'"
                            : option.value == "FILE" ? " -r -F"
                                                     : " -x",
                            for_fish(option.doc));
  }
  return script;
}

}  // namespace

std::vector<std::string> const& completion_shells() {
  static std::vector<std::string> const shells{"bash", "zsh", "fish"};
  return shells;
}

int completion(std::string const& shell, std::vector<CommandWords> const& commands) {
  std::string script;
  if (shell == "bash")
    script = bash(commands);
  else if (shell == "zsh")
    script = zsh(commands);
  else if (shell == "fish")
    script = fish(commands);
  else
    throw Error(fmt::format("there is no completion for '{}'{}", shell, choices(shell, completion_shells())));
  std::fputs(script.c_str(), stdout);
  return 0;
}

}  // namespace boltzmann::bzm
