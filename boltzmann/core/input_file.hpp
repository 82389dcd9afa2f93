// What a user names to be read.
#pragma once

#include <iosfwd>
#include <string>

namespace boltzmann {

/// Error if there is something of this name but no regular file: a folder can't be read, a device or pipe may never
/// end.
void need_regular_file(std::string const& path);

/// The next line of the file at `path`, without its end; false if there is none. Error for lines above 1 MB, which no
/// file of text has.
bool read_line(std::istream& file, std::string& line, std::string const& path);

}  // namespace boltzmann
