/* A libgmsh that passes all calls on to the one that REAL_GMSH_LIB names, but for one, which fails
   or is interrupted. It says which one it is by faulty_arm, or, for a program, by the environment
   variable FAULTY_GMSH ("name call action").

   Arguments are passed on as whole words, which suits all functions but those with a double. */

#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum Action { fail_before = 1, fail_after, interrupt_before, interrupt_after, fail_ever_after };

static char armed_name[64];
static long armed_call = 0;
static enum Action armed_action = fail_before;

enum { most_names = 200000 };
static const char* names[most_names];
static long count = 0;          /* of all calls since it was armed */
static long matching_count = 0; /* of those of the armed name */

static void* real(const char* name) {
  static void* library = NULL;
  if (library == NULL) {
    library = dlopen(getenv("REAL_GMSH_LIB"), RTLD_NOW | RTLD_LOCAL);
  }
  void* found = library == NULL ? NULL : dlsym(library, name);
  if (found == NULL) {
    fprintf(stderr, "faulty_gmsh: no %s (%s)\n", name, dlerror());
    abort();
  }
  return found;
}

/* Of all functions if the name is empty. Call 0: none, only count. */
void faulty_arm(const char* name, long call, int action) {
  strncpy(armed_name, name, sizeof armed_name - 1);
  armed_call = call;
  armed_action = (enum Action)action;
  count = 0;
  matching_count = 0;
}

long faulty_count(void) { return count; }
const char* faulty_name(long call) { return names[call]; }

static void arm_by_environment(void) {
  static int is_read = 0;
  const char* text = getenv("FAULTY_GMSH");
  char name[64];
  long call = 0;
  int action = 0;
  if (!is_read && text != NULL && sscanf(text, "%63s %ld %d", name, &call, &action) == 3) {
    faulty_arm(name, call, action);
  }
  is_read = 1;
}

/* Counts the call; the action if it is the one, else 0. */
static int count_call(const char* name) {
  arm_by_environment();
  if (count < most_names) {
    names[count] = name;
  }
  ++count;
  if (armed_name[0] != '\0' && strcmp(name, armed_name) != 0) {
    return 0;
  }
  ++matching_count;
  if (armed_call > 0 && armed_action == fail_ever_after && matching_count >= armed_call) {
    return fail_before;
  }
  return matching_count == armed_call ? (int)armed_action : 0;
}

#define CALL(name, type, parameters, arguments, error)   \
  long name parameters {                                 \
    const int action = count_call(#name);                \
    long result = 0;                                     \
    if (action == interrupt_before) {                    \
      raise(SIGINT);                                     \
    }                                                    \
    if (action != fail_before) {                         \
      result = ((long(*) type)real(#name))arguments;     \
    }                                                    \
    if (action == fail_before || action == fail_after) { \
      *(int*)(error) = 1;                                \
    }                                                    \
    if (action == interrupt_after) {                     \
      raise(SIGINT);                                     \
    }                                                    \
    return result;                                       \
  }

#define T1 long
#define T2 T1, long
#define T3 T2, long
#define T4 T3, long
#define T5 T4, long
#define T6 T5, long
#define T7 T6, long
#define T8 T7, long
#define T9 T8, long
#define T10 T9, long
#define T11 T10, long
#define P1 long a1
#define P2 P1, long a2
#define P3 P2, long a3
#define P4 P3, long a4
#define P5 P4, long a5
#define P6 P5, long a6
#define P7 P6, long a7
#define P8 P7, long a8
#define P9 P8, long a9
#define P10 P9, long a10
#define P11 P10, long a11
#define A1 a1
#define A2 A1, a2
#define A3 A2, a3
#define A4 A3, a4
#define A5 A4, a5
#define A6 A5, a6
#define A7 A6, a7
#define A8 A7, a8
#define A9 A8, a9
#define A10 A9, a10
#define A11 A10, a11

/* By the number of arguments, the error flag at the end included. */
#define PASS_ON(name, n) CALL(name, (T##n), (P##n), (A##n), a##n)

PASS_ON(gmshFinalize, 1)
PASS_ON(gmshLoggerGetLastError, 2)
PASS_ON(gmshLoggerWrite, 3)
PASS_ON(gmshMerge, 2)
PASS_ON(gmshModelAddDiscreteEntity, 5)
PASS_ON(gmshModelGeoRemove, 4)
PASS_ON(gmshModelGetBoundary, 8)
PASS_ON(gmshModelGetBoundingBox, 9)
PASS_ON(gmshModelGetCurrent, 2)
PASS_ON(gmshModelGetDerivative, 7)
PASS_ON(gmshModelGetEntities, 4)
PASS_ON(gmshModelGetEntitiesForPhysicalGroup, 5)
PASS_ON(gmshModelGetNormal, 6)
PASS_ON(gmshModelGetParametrization, 7)
PASS_ON(gmshModelGetParametrizationBounds, 7)
PASS_ON(gmshModelGetPhysicalGroups, 4)
PASS_ON(gmshModelGetPhysicalName, 4)
PASS_ON(gmshModelGetType, 4)
PASS_ON(gmshModelGetValue, 7)
PASS_ON(gmshModelGetVisibility, 4)
PASS_ON(gmshModelList, 3)
PASS_ON(gmshModelMeshAddElementsByType, 7)
PASS_ON(gmshModelMeshAddNodes, 9)
PASS_ON(gmshModelMeshClear, 3)
PASS_ON(gmshModelMeshGenerate, 2)
PASS_ON(gmshModelMeshGetElementProperties, 9)
PASS_ON(gmshModelMeshGetElementType, 4)
PASS_ON(gmshModelMeshGetElementTypes, 5)
PASS_ON(gmshModelMeshGetElements, 11)
PASS_ON(gmshModelMeshGetEmbedded, 5)
PASS_ON(gmshModelMeshGetNodes, 11)
PASS_ON(gmshModelMeshGetPeriodicNodes, 11)
PASS_ON(gmshModelMeshOptimize, 6)
PASS_ON(gmshModelMeshRemoveSizeCallback, 1)
PASS_ON(gmshModelMeshSetOrder, 2)
PASS_ON(gmshModelRemoveEntities, 4)
PASS_ON(gmshModelReparametrizeOnSurface, 9)
PASS_ON(gmshModelSetCurrent, 2)
PASS_ON(gmshModelSetVisibility, 5)
PASS_ON(gmshOnelabClear, 2)
PASS_ON(gmshOnelabGetNames, 4)
PASS_ON(gmshOnelabGetString, 4)
PASS_ON(gmshOnelabSetString, 4)
PASS_ON(gmshOpen, 2)
PASS_ON(gmshOptionGetNumber, 3)
PASS_ON(gmshOptionGetString, 3)
PASS_ON(gmshViewAdd, 3)
PASS_ON(gmshViewAddListData, 6)
PASS_ON(gmshViewRemove, 2)
PASS_ON(gmshWrite, 2)

CALL(gmshOptionSetNumber, (const char*, double, long), (const char* name, double value, long error),
     (name, value, error), error)

#ifdef SINCE_49 /* functions that have other arguments since Gmsh 4.9 */
PASS_ON(gmshInitialize, 5)
PASS_ON(gmshModelIsInside, 6)
PASS_ON(gmshModelMeshGetMaxNodeTag, 2)
PASS_ON(gmshModelMeshPartition, 6)
#else
PASS_ON(gmshInitialize, 4)
PASS_ON(gmshModelIsInside, 5)
PASS_ON(gmshModelMeshPartition, 2)
#endif

void gmshFree(void* memory) { ((void (*)(void*))real("gmshFree"))(memory); }

/* Questions for sizes count as calls of "size0" to "size3", by dimension. */

#ifdef SINCE_49
typedef double (*Callback)(int, int, double, double, double, double, void*);
#else
typedef double (*Callback)(int, int, double, double, double, void*);
#endif
typedef struct {
  long callback;
  void* data;
} Asked;

static void count_question(int dim) {
  static const char* const question[] = {"size0", "size1", "size2", "size3"};
  const int action = count_call(question[dim & 3]);
  if (action == interrupt_before || action == interrupt_after) {
    raise(SIGINT);
  }
}

#ifdef SINCE_49
static double ask(int dim, int tag, double x, double y, double z, double lc, void* data) {
  count_question(dim);
  return ((Callback)((Asked*)data)->callback)(dim, tag, x, y, z, lc, ((Asked*)data)->data);
}
#else
static double ask(int dim, int tag, double x, double y, double z, void* data) {
  count_question(dim);
  return ((Callback)((Asked*)data)->callback)(dim, tag, x, y, z, ((Asked*)data)->data);
}
#endif

static long set_callback(long callback, long data, long error) {
  Asked* asked = malloc(sizeof(Asked));
  asked->callback = callback;
  asked->data = (void*)data;
  return ((long (*)(long, long, long))real("gmshModelMeshSetSizeCallback"))((long)&ask, (long)asked,
                                                                            error);
}

long gmshModelMeshSetSizeCallback(long callback, long data, long error) {
  const int action = count_call("gmshModelMeshSetSizeCallback");
  long result = 0;
  if (action != fail_before) {
    result = set_callback(callback, data, error);
  }
  if (action == fail_before || action == fail_after) {
    *(int*)error = 1;
  }
  return result;
}
