// Address file: stores the address of the window of the run in a folder; readable only by its owner.
#pragma once

#include <optional>
#include <string>

namespace boltzmann {

/// While this object exists, `folder`/window.txt contains the address (as soon as the folder exists).
class AddressFile {
 public:
  AddressFile(std::string folder, std::string address);
  ~AddressFile();
  AddressFile(AddressFile const&) = delete;
  AddressFile& operator=(AddressFile const&) = delete;

 private:
  std::string path_, address_;
};

/// Prints the address of a window on standard output. On a terminal: "window: http://...". Elsewhere, where others may
/// read the output, it prints the name of a file with the address, which only its owner can read and which is removed
/// with this object.
class Announcement {
 public:
  /// `what`: "window", "gallery". Throws Error if the file can't be created.
  Announcement(std::string const& what, std::string const& address);
  ~Announcement();
  Announcement(Announcement const&) = delete;
  Announcement& operator=(Announcement const&) = delete;

 private:
  std::string path_;
};

/// The address in `folder`/window.txt, if a server still listens there.
std::optional<std::string> living_window(std::string const& folder);

}  // namespace boltzmann
