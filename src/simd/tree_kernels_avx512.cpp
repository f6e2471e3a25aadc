#define KERNEL_NAMESPACE avx512
#define KERNEL_NAME "avx512"
#include "tree_kernels_body.h"
