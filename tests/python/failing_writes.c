/* Loaded before everything else: lets what is written to unfinished files fail.

   FAIL_WRITES=full  there is no room for any of it
   FAIL_WRITES=kill  the process is killed (SIGKILL) at the second piece
   FAIL_WRITES=interrupt  it gets Ctrl-C (SIGINT) at the second piece
   FAIL_WRITES=move  it is killed when the file is complete and about to be moved to its place

   FAIL_FILE names a part of the path of the only file concerned. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

static int pieces = 0;

static int is_asked_for(const char *what) {
  const char *asked = getenv("FAIL_WRITES");
  return asked != NULL && strcmp(asked, what) == 0;
}

static int is_unfinished(int file) {
  char link[64];
  char path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) {
    return 0;
  }
  path[length] = '\0';
  const char *only = getenv("FAIL_FILE");
  return strstr(path, ".unfinished") != NULL && (only == NULL || strstr(path, only) != NULL);
}

/* Whether the piece must not be written. */
static int fails(int file) {
  if (!is_unfinished(file)) {
    return 0;
  }
  if (is_asked_for("kill") && ++pieces == 2) {
    kill(getpid(), SIGKILL);
  }
  if (is_asked_for("interrupt") && ++pieces == 2) {
    kill(getpid(), SIGINT);
  }
  return is_asked_for("full");
}

ssize_t write(int file, const void *bytes, size_t count) {
  static ssize_t (*real)(int, const void *, size_t) = NULL;
  if (real == NULL) {
    *(void **)&real = dlsym(RTLD_NEXT, "write");
  }
  if (fails(file)) {
    errno = ENOSPC;
    return -1;
  }
  return real(file, bytes, count);
}

ssize_t writev(int file, const struct iovec *pieces_of, int count) {
  static ssize_t (*real)(int, const struct iovec *, int) = NULL;
  if (real == NULL) {
    *(void **)&real = dlsym(RTLD_NEXT, "writev");
  }
  if (fails(file)) {
    errno = ENOSPC;
    return -1;
  }
  return real(file, pieces_of, count);
}

int rename(const char *from, const char *to) {
  static int (*real)(const char *, const char *) = NULL;
  if (real == NULL) {
    *(void **)&real = dlsym(RTLD_NEXT, "rename");
  }
  if (is_asked_for("move") && strstr(from, ".unfinished") != NULL) {
    kill(getpid(), SIGKILL);
  }
  return real(from, to);
}
