// Address file: where the window of the run in a folder is, for those who come later; readable by its owner only.
#pragma once

#include <optional>
#include <string>

namespace boltzmann {

/// While it lives, `folder`/window.txt holds the address (from the moment on at which the folder exists).
class AddressFile {
 public:
  AddressFile(std::string folder, std::string address);
  ~AddressFile();
  AddressFile(AddressFile const&) = delete;
  AddressFile& operator=(AddressFile const&) = delete;

 private:
  std::string path_, address_;
};

/// Says the address of a window on standard output: on a terminal, "window: http://..."; elsewhere, where others may
/// read it, in which file it stands, which its owner alone may read and which is gone with the announcement.
class Announcement {
 public:
  /// `what`: "window", "gallery". Error if there is no place for the file.
  Announcement(std::string const& what, std::string const& address);
  ~Announcement();
  Announcement(Announcement const&) = delete;
  Announcement& operator=(Announcement const&) = delete;

 private:
  std::string path_;
};

/// The address in `folder`/window.txt, if somebody still listens there.
std::optional<std::string> living_window(std::string const& folder);

}  // namespace boltzmann
