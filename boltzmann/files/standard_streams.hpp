// Standard input, output and error of a process that was started without them (>&- 2>&-, cron, batch systems).
#pragma once

namespace boltzmann {

/// Opens those of the descriptors 0, 1 and 2 that are closed on /dev/null. Otherwise the first opened file would get
/// such a number, and printed text would go into it. Call it before any file is opened.
void open_standard_streams();

}  // namespace boltzmann
