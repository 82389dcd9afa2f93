# Which state of the source this is: "0.1.0-79-g1159b0a" (79 commits after the tag v0.1.0, or since the first commit where there
# is no tag; -dirty with changes that are not committed), or the project's version where there is no git.
# As a script, with -DSOURCE=, -DVERSION= and -DOUTPUT=: writes the definition of boltzmann::bzm::described_version, if it has changed.
function(describe source version result)
  set(${result} "${version}" PARENT_SCOPE)
  find_program(GIT git)
  if(NOT GIT OR NOT EXISTS "${source}/.git")
    return()
  endif()
  # Root may build what a user has cloned (sudo make install).
  set(git ${GIT} -c safe.directory=${source} -C ${source})
  execute_process(COMMAND ${git} describe --tags --match "v[0-9]*" --dirty OUTPUT_VARIABLE text ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
  if(NOT failed)
    string(REGEX REPLACE "^v" "" text "${text}")
    set(${result} "${text}" PARENT_SCOPE)
    return()
  endif()
  execute_process(COMMAND ${git} rev-list --count HEAD OUTPUT_VARIABLE count ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE
                  RESULT_VARIABLE failed)
  execute_process(COMMAND ${git} describe --always --dirty OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed AND commit)
    set(${result} "${version}-${count}-g${commit}" PARENT_SCOPE)
  endif()
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  describe("${SOURCE}" "${VERSION}" described)
  set(text "// Written by cmake/describe.cmake.
namespace boltzmann::bzm {
extern char const* const described_version;
char const* const described_version = \"${described}\";
}  // namespace boltzmann::bzm
")
  set(old "")
  if(EXISTS "${OUTPUT}")
    file(READ "${OUTPUT}" old)
  endif()
  if(NOT old STREQUAL text)
    file(WRITE "${OUTPUT}" "${text}")
  endif()
endif()
