// Files have mode 600, because the token permits control of the run.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/files/folder_lock.hpp>
#include <boltzmann/window/address_file.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace boltzmann {
namespace {

std::string path_in(std::string const& folder) { return folder + "/window.txt"; }

// True if a line is an address in this program's format, so that nothing else is ever printed.
bool is_address(std::string_view line) {
  constexpr std::string_view begin = "http://127.0.0.1:",
                             letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~%";
  if (line.size() > 500 || !line.starts_with(begin)) return false;
  line.remove_prefix(begin.size());
  std::size_t const slash = line.find_first_not_of("0123456789");
  constexpr std::string_view query = "/?token=";
  return slash != std::string_view::npos && line.substr(slash).starts_with(query) &&
         line.substr(slash + query.size()).find_first_not_of(letters) == std::string_view::npos;
}

// The port of "http://127.0.0.1:40123/?token=...", or 0.
int port_of(std::string const& address) {
  std::string const start = "http://127.0.0.1:";
  return address.starts_with(start) ? std::atoi(address.c_str() + start.size()) : 0;
}

bool listens(int port) {
  int const socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return false;
  sockaddr_in there{};
  there.sin_family = AF_INET;
  there.sin_port = htons(static_cast<std::uint16_t>(port));
  there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  bool const answered = connect(socket, reinterpret_cast<sockaddr const*>(&there), sizeof there) == 0;
  ::close(socket);
  return answered;
}

}  // namespace

AddressFile::AddressFile(std::string folder, std::string address)
    : path_(path_in(folder)), address_(std::move(address)) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  own_window_file(folder);
  std::filesystem::remove(path_, ignored);
  int const file = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return;  // the run itself reports what is wrong with the folder
  std::string const line = address_ + "\n";
  if (write(file, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    std::filesystem::remove(path_, ignored);
  ::close(file);
}

AddressFile::~AddressFile() {
  std::ifstream file(path_);
  std::string line;
  std::error_code ignored;
  if (std::getline(file, line) && line == address_) std::filesystem::remove(path_, ignored);
}

Announcement::Announcement(std::string const& what, std::string const& address) {
  // A launcher gives ranks a terminal even if its own output is redirected.
  if (isatty(STDOUT_FILENO) == 1 && team().alone()) {
    fmt::print("{}: {}\n", what, address);
  } else {
    path_ = (std::filesystem::temp_directory_path() / "boltzmann-window-XXXXXX").string();
    int const file = mkstemp(path_.data());  // mode 600
    std::string const line = address + "\n";
    bool const whole = file >= 0 && write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    std::string const why = std::strerror(errno);
    if (file >= 0) ::close(file);
    if (!whole) throw Error(fmt::format("the address of the window can't be written to '{}': {}", path_, why));
    fmt::print("{}: its address is in {}\n", what, path_);
  }
  std::fflush(stdout);
}

Announcement::~Announcement() {
  if (!path_.empty()) ::unlink(path_.c_str());
}

std::optional<std::string> living_window(std::string const& folder) {
  std::ifstream file(path_in(folder));
  std::string line;
  if (!std::getline(file, line) || !is_address(line)) return std::nullopt;
  int const port = port_of(line);
  if (port <= 0 || port > 65535 || !listens(port)) return std::nullopt;
  return line;
}

}  // namespace boltzmann
