/* libboltzmann_mpi.so: a team of processes by MPI, compiled by the MPI that a machine has:
     mpicc -O2 -shared -fPIC mpi_plugin.c -o libboltzmann_mpi.so
   No other part of Boltzmann uses MPI. */
#include "team_functions.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>

static MPI_Comm team = MPI_COMM_NULL; /* for our messages, separate from those of the program */
static MPI_Request one = MPI_REQUEST_NULL, *under_way = &one; /* `requests` pending ones */
static int requests = 1;
static MPI_Request* of_messages = NULL; /* memory for `room` requests */
static int room = 0;
static int ours = 0; /* whether MPI was initialised here */

static char const* library(void) {
  static char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  if (MPI_Get_library_version(text, &length) != MPI_SUCCESS) return "MPI";
  text[strcspn(text, "\n")] = 0;
  return text;
}

static int join(void* of, int* rank, int* size) {
  int begun = 0, level = 0, error = MPI_Initialized(&begun);
  (void)of;
  if (error == MPI_SUCCESS && !begun) {
    error = MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &level);
    ours = error == MPI_SUCCESS;
  }
  if (error == MPI_SUCCESS) error = MPI_Comm_dup(MPI_COMM_WORLD, &team);
  if (error == MPI_SUCCESS) error = MPI_Comm_rank(team, rank);
  if (error == MPI_SUCCESS) error = MPI_Comm_size(team, size);
  return error == MPI_SUCCESS ? 0 : error;
}

static MPI_Request* collective(void) {
  requests = 1;
  return under_way = &one;
}

static void begin_reduce(void* of, int64_t* numbers, int count, int operation) {
  MPI_Op const op = operation == boltzmann_team_sum ? MPI_SUM : operation == boltzmann_team_min ? MPI_MIN : MPI_MAX;
  (void)of;
  MPI_Iallreduce(MPI_IN_PLACE, numbers, count, MPI_INT64_T, op, team, collective());
}

static void begin_broadcast(void* of, void* bytes, int count, int from) {
  (void)of;
  MPI_Ibcast(bytes, count, MPI_BYTE, from, team, collective());
}

static void begin_gather(void* of, void const* mine, int count, void* all) {
  (void)of;
  MPI_Iallgather(mine, count, MPI_BYTE, all, count, MPI_BYTE, team, collective());
}

static void begin_exchange(void* of, BoltzmannMessage const* messages, int count) {
  int const tag = 1;
  int k;
  (void)of;
  if (count > room) {
    of_messages = (MPI_Request*)realloc(of_messages, (size_t)count * sizeof(MPI_Request));
    room = count;
    if (!of_messages) MPI_Abort(MPI_COMM_WORLD, 1);
  }
  under_way = of_messages;
  requests = count;
  for (k = 0; k < count; ++k)
    if (messages[k].receive)
      MPI_Irecv(messages[k].bytes, messages[k].count, MPI_BYTE, messages[k].rank, tag, team, of_messages + k);
  for (k = 0; k < count; ++k)
    if (!messages[k].receive)
      MPI_Isend(messages[k].bytes, messages[k].count, MPI_BYTE, messages[k].rank, tag, team, of_messages + k);
}

static int done(void* of) {
  int flag = 0;
  (void)of;
  MPI_Testall(requests, under_way, &flag, MPI_STATUSES_IGNORE);
  return flag;
}

static void leave(void* of) {
  int finished = 0;
  (void)of;
  MPI_Finalized(&finished);
  if (finished) return;
  MPI_Comm_free(&team);
  if (ours) MPI_Finalize();
}

static void end_all(void* of, int status) {
  (void)of;
  MPI_Abort(MPI_COMM_WORLD, status);
}

BoltzmannTeamFunctions const* boltzmann_mpi(void) {
  static BoltzmannTeamFunctions const functions = {
      boltzmann_team_version, library, join, begin_reduce, begin_broadcast, begin_gather, begin_exchange, NULL, NULL, NULL,
      done, leave, end_all};
  return &functions;
}
