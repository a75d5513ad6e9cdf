/* A clock that a test sets while programs run, for programs that load this with LD_PRELOAD. The file in SHIFTED_CLOCK
   contains the difference of the time of day to that of the machine, in seconds (64 bits). Monotonic clocks, and waits
   by them, do not change. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <time.h>

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define A_LONG_TIME_AFTER_BOOT 1000000000 /* seconds: an absolute time above is one of the time of day */

static volatile int64_t *offset;

__attribute__((constructor)) static void load(void) {
    const char *path = getenv("SHIFTED_CLOCK");
    int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    void *data = file < 0 ? MAP_FAILED : mmap(NULL, sizeof *offset, PROT_READ, MAP_SHARED, file, 0);
    offset = data == MAP_FAILED ? NULL : data;
}

static int64_t shift(void) { return offset ? *offset : 0; }

int clock_gettime(clockid_t clock, struct timespec *now) {
    int result = REAL(clock_gettime)(clock, now);
    if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE || clock == CLOCK_TAI))
        now->tv_sec += shift();
    return result;
}

int gettimeofday(struct timeval *now, void *zone) {
    int result = REAL(gettimeofday)(now, zone);
    if (result == 0) now->tv_sec += shift();
    return result;
}

time_t time(time_t *place) {
    time_t now = REAL(time)(NULL) + shift();
    if (place) *place = now;
    return now;
}

int timespec_get(struct timespec *now, int base) {
    return base == TIME_UTC && clock_gettime(CLOCK_REALTIME, now) == 0 ? base : 0;
}

/* Who waits until a time of day means that of the shifted clock. */
static struct timespec until(const struct timespec *end) {
    struct timespec real = *end;
    if (real.tv_sec > A_LONG_TIME_AFTER_BOOT) real.tv_sec -= shift();
    return real;
}

int pthread_cond_timedwait(pthread_cond_t *condition, pthread_mutex_t *mutex, const struct timespec *end) {
    struct timespec real = until(end);
    return REAL(pthread_cond_timedwait)(condition, mutex, &real);
}

int sem_timedwait(sem_t *semaphore, const struct timespec *end) {
    struct timespec real = until(end);
    return REAL(sem_timedwait)(semaphore, &real);
}
