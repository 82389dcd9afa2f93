// Reads files that a user names.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>

namespace boltzmann {

/// Error if this name exists but is not a regular file: a folder can't be read, a device or pipe may never end.
void need_regular_file(std::string const& path);

/// A stream of the text of a file, which may be compressed by gzip. Error if it can't be opened or uses another
/// compression. Reading throws an Error if the compressed data is damaged. `what` describes the file in messages: "XYZ
/// file".
std::unique_ptr<std::istream> open_text(std::string const& path, std::string const& what);

/// "water.data" of "water.data.gz"; other paths as they are.
std::string without_gz(std::string const& path);

/// Reads the next line of the file at `path`, without its end; false if there is none. Error for lines above 1 MB: it
/// is no text file.
bool read_line(std::istream& file, std::string& line, std::string const& path);

}  // namespace boltzmann
