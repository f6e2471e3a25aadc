/* Records the sizes that Gmsh asks for in a run, and answers the same questions again: for
 * mesh_runs.py, which tells what the runs are for.
 *
 * It stands between meshgrow and Gmsh without changing either: it has two functions by the names of
 * Gmsh's own. Where it is loaded for all (RTLD_GLOBAL) and then libgmsh, too, meshgrow finds these
 * two, so that all that meshgrow does with Gmsh's mesher, in the user's own way, passes here.
 *
 * What is recorded is in memory that is shared with processes forked after recorder_create.
 *
 * Gmsh 4.8 calls back without the last double, later versions with it: both kinds are here. Gmsh
 * must mesh on one thread: the order of the questions is what is compared. */

#define _GNU_SOURCE /* MAP_ANONYMOUS, MAP_NORESERVE */

#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

#define NO_SIZE 1e22 /* what Gmsh takes for "no size" */
#define MAX_PASSES 64

typedef double (*callback48)(int dim, int tag, double x, double y, double z, void* data);
typedef double (*callback49)(int dim, int tag, double x, double y, double z, double lc, void* data);

typedef struct {
  int dim, tag;
  double x, y, z, size;
} question;

/* What is done in a run of meshgrow:
 * PASS_ON  nothing
 * RECORD   every question of Gmsh and the answer are kept
 * REPLAY   Gmsh gets the recorded answers in place of meshgrow's, the n-th to the n-th question
 * ASK      each call of the mesher first asks meshgrow the questions of that call in the recorded
 *          run; the last call does nothing else, and fails
 * A run begins with one of them but REPLAY. At the door, which is before the last call of the
 * mesher in a RECORD run, it may go over to REPLAY. */
enum { PASS_ON = 0, RECORD = 1, REPLAY = 2, ASK = 3 };

static struct {
  size_t count, capacity;
  size_t pass_begin[MAX_PASSES + 1]; /* in questions, of each call of the mesher */
  int overflow;
  question questions[];
} * record;

static double* sizes; /* ASK: the answers */

static struct {
  int is_48;
  void (*set_size_callback)(void* callback, void* data, int* error);
  void (*generate)(int dim, int* error);
} gmsh;

static struct {
  int mode;
  void* callback; /* meshgrow's */
  void* data;
  size_t pass, last_pass;
  void (*door)(void);
  double begin, end, in_gmsh, asking;
} run;

static struct { size_t next, mismatches; } replay;

double recorder_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ==== Meshgrow -> here -> Gmsh ==== */

static void note(int dim, int tag, double x, double y, double z, double size) {
  if (record->count == record->capacity) {
    record->overflow = 1;
    return;
  }
  const question asked = {dim, tag, x, y, z, size};
  record->questions[record->count++] = asked;
}

static double ask(int dim, int tag, double x, double y, double z, double lc) {
  return gmsh.is_48 ? ((callback48)run.callback)(dim, tag, x, y, z, run.data)
                    : ((callback49)run.callback)(dim, tag, x, y, z, lc, run.data);
}

static double replayed(int dim, int tag, double x, double y, double z) {
  if (replay.next == record->count) {
    ++replay.mismatches;
    return NO_SIZE;
  }
  const question* q = &record->questions[replay.next++];
  replay.mismatches +=
      (size_t)(q->dim != dim || q->tag != tag || q->x != x || q->y != y || q->z != z);
  return q->size;
}

static double between(int dim, int tag, double x, double y, double z, double lc) {
  if (run.mode == REPLAY) {
    return replayed(dim, tag, x, y, z);
  }
  const double begin = recorder_now();
  const double size = ask(dim, tag, x, y, z, lc);
  note(dim, tag, x, y, z, size);
  run.asking += recorder_now() - begin;
  return size;
}

static double between48(int dim, int tag, double x, double y, double z, void* data) {
  (void)data;
  return between(dim, tag, x, y, z, NO_SIZE);
}

static double between49(int dim, int tag, double x, double y, double z, double lc, void* data) {
  (void)data;
  return between(dim, tag, x, y, z, lc);
}

static double replayed48(int dim, int tag, double x, double y, double z, void* data) {
  (void)data;
  return replayed(dim, tag, x, y, z);
}

static double replayed49(int dim, int tag, double x, double y, double z, double lc, void* data) {
  (void)lc;
  (void)data;
  return replayed(dim, tag, x, y, z);
}

static void* callback_of(callback48 until_48, callback49 since_49) {
  return gmsh.is_48 ? (void*)until_48 : (void*)since_49;
}

void gmshModelMeshSetSizeCallback(void* callback, void* data, int* error) {
  run.callback = callback;
  run.data = data;
  if (run.mode == RECORD) {
    callback = callback_of(between48, between49);
  }
  gmsh.set_size_callback(callback, data, error);
}

static void ask_all_of_pass(size_t pass) {
  const double begin = recorder_now();
  for (size_t i = record->pass_begin[pass]; i < record->pass_begin[pass + 1]; ++i) {
    const question* q = &record->questions[i];
    sizes[i] = ask(q->dim, q->tag, q->x, q->y, q->z, NO_SIZE);
  }
  run.end = recorder_now();
  run.asking += run.end - begin;
}

void gmshModelMeshGenerate(int dim, int* error) {
  *error = 1;
  if (run.pass > run.last_pass) {
    return;
  }
  if (run.pass == run.last_pass && run.door != NULL) {
    run.door();
  }
  if (run.mode == ASK) {
    ask_all_of_pass(run.pass);
    if (run.pass == run.last_pass) {
      ++run.pass;
      return; /* all is asked: nothing needs to be meshed any more */
    }
  }
  const double asking = run.asking;
  const double begin = recorder_now();
  gmsh.generate(dim, error);
  run.in_gmsh += recorder_now() - begin - (run.asking - asking);
  ++run.pass;
  if (run.mode == RECORD) {
    record->pass_begin[run.pass] = record->count;
  }
}

/* ==== For mesh_runs.py ==== */

/* Gmsh's own functions, and how many questions may be asked. */
int recorder_create(int is_48, void* set_size_callback, void* generate, size_t capacity) {
  gmsh.is_48 = is_48;
  gmsh.set_size_callback = (void (*)(void*, void*, int*))set_size_callback;
  gmsh.generate = (void (*)(int, int*))generate;
  /* Pages of it are taken when they are written to. */
  record = mmap(NULL, sizeof *record + capacity * sizeof(question), PROT_READ | PROT_WRITE,
                MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  sizes = mmap(NULL, capacity * sizeof(double), PROT_READ | PROT_WRITE,
               MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (record == MAP_FAILED || sizes == MAP_FAILED) {
    return 1;
  }
  record->capacity = capacity;
  return 0;
}

/* Begins a run (see the top) of so many calls of the mesher, and its clock. */
int recorder_begin(int mode, size_t passes, void (*door)(void)) {
  if (passes == 0 || passes > MAX_PASSES) {
    return 1;
  }
  memset(&run, 0, sizeof run);
  run.mode = mode;
  run.last_pass = passes - 1;
  run.door = door;
  if (mode == RECORD) {
    record->count = 0;
  } else if (mode == ASK) {
    memset(sizes, 0, record->count * sizeof(double)); /* no page faults on the clock */
  }
  run.begin = recorder_now();
  return 0;
}

/* At the door of a run: its last call of the mesher gets the recorded answers. */
void recorder_go_over_to_replay(void) {
  run.mode = REPLAY;
  replay.next = record->pass_begin[run.pass];
  replay.mismatches = 0;
}

/* After a run, -1 if it did not make all its calls of the mesher. ASK: seconds from begin to the
 * last answer without those in Gmsh's mesher; others: seconds in Gmsh's mesher, of RECORD and
 * REPLAY without those of meshgrow's answers. */
double recorder_seconds(void) {
  if (run.pass != run.last_pass + 1 || record->overflow) {
    return -1.0;
  }
  return run.mode == ASK ? run.end - run.begin - run.in_gmsh : run.in_gmsh;
}

/* Seconds of the answers alone, of ASK and RECORD. */
double recorder_seconds_asking(void) { return run.asking; }

size_t recorder_count(void) { return record->count; }
const double* recorder_sizes(void) { return sizes; }

/* Gmsh gets the recorded answers from now on, without meshgrow. */
void recorder_replay(int* error) {
  memset(&replay, 0, sizeof replay);
  gmsh.set_size_callback(callback_of(replayed48, replayed49), NULL, error);
}

/* Questions that were others than recorded, and how many were asked. */
size_t recorder_mismatches(void) { return replay.mismatches; }
size_t recorder_replayed(void) { return replay.next; }
