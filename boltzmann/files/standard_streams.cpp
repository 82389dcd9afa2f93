// Opens closed descriptors 0 to 2 on /dev/null.
#include <boltzmann/files/standard_streams.hpp>

#include <fcntl.h>
#include <unistd.h>

namespace boltzmann {

void open_standard_streams() {
  for (int descriptor = 0; descriptor < 3;) {
    if (fcntl(descriptor, F_GETFD) >= 0) {
      ++descriptor;
      continue;
    }
    int const opened = open("/dev/null", O_RDWR);  // returns the lowest free number
    if (opened < 0) return;
    descriptor = opened + 1;
  }
}

}  // namespace boltzmann
