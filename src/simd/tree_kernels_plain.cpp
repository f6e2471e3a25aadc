#define KERNEL_NAMESPACE plain
#define KERNEL_NAME "plain"
#include "tree_kernels_body.h"
