// Standard input, output and error of a process that was started without them (>&- 2>&-, cron, batch systems).
#pragma once

namespace boltzmann {

/// Opens those of the descriptors 0, 1 and 2 that are closed on /dev/null. Else the first file that is opened gets such
/// a number, and what is printed goes into it. To be called before any file is opened.
void open_standard_streams();

}  // namespace boltzmann
