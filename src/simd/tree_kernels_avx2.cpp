#define KERNEL_NAMESPACE avx2
#define KERNEL_NAME "avx2"
#include "tree_kernels_body.h"
