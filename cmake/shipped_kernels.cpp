#define SHIPPED_KERNELS template
#include "shipped_kernels.hpp"
