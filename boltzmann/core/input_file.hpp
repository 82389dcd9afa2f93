// What a user names to be read.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>

namespace boltzmann {

/// Error if there is something of this name but no regular file: a folder can't be read, a device or pipe may never
/// end.
void need_regular_file(std::string const& path);

/// A stream of the text of a file, which may be compressed by gzip. Error if it can't be opened, or is compressed in
/// another way; reading throws an Error if the compressed data is damaged. `what` it is for messages, "XYZ file".
std::unique_ptr<std::istream> open_text(std::string const& path, std::string const& what);

/// "water.data" of "water.data.gz"; other paths as they are.
std::string without_gz(std::string const& path);

/// The next line of the file at `path`, without its end; false if there is none. Error for lines above 1 MB, which no
/// file of text has.
bool read_line(std::istream& file, std::string& line, std::string const& path);

}  // namespace boltzmann
