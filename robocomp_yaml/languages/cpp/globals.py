"""Names of the C library's functions, types and variables, which are in no namespace: nothing in C++ can have them.

Made by `make macros`, which adds what the compiler at hand knows. Do not edit: change tests/ice/cpp_macros.py.
"""

from __future__ import annotations

_FUNCTIONS = frozenset(  # of mathematics
    """acos acosh asin asinh atan atan2 atanh canonicalize cbrt ceil copysign cos cosh erf erfc exp exp10 exp2 expm1
    fabs fdim floor fma fmax fmaximum fmaximum_mag fmaximum_mag_num fmaximum_num fmaxmag fmin fminimum fminimum_mag
    fminimum_mag_num fminimum_num fminmag fmod frexp fromfp fromfpx getpayload hypot ilogb j0 j1 jn ldexp lgamma
    llogb llrint llround log log10 log1p log2 logb lrint lround modf nan nearbyint nextafter nextdown nextup pow
    remainder remquo rint round roundeven scalbln scalbn setpayload setpayloadsig sin sincos sinh sqrt tan tanh
    tgamma totalorder totalordermag trunc ufromfp ufromfpx y0 y1 yn""".split()
)
_OTHERS = frozenset(
    """FILE F_OWNER_GID F_OWNER_PGRP F_OWNER_PID F_OWNER_TID ITIMER_PROF ITIMER_REAL ITIMER_VIRTUAL
    PTHREAD_CANCEL_ASYNCHRONOUS PTHREAD_CANCEL_DEFERRED PTHREAD_CANCEL_DISABLE PTHREAD_CANCEL_ENABLE
    PTHREAD_CREATE_DETACHED PTHREAD_CREATE_JOINABLE PTHREAD_EXPLICIT_SCHED PTHREAD_INHERIT_SCHED
    PTHREAD_MUTEX_ADAPTIVE_NP PTHREAD_MUTEX_DEFAULT PTHREAD_MUTEX_ERRORCHECK PTHREAD_MUTEX_ERRORCHECK_NP
    PTHREAD_MUTEX_FAST_NP PTHREAD_MUTEX_NORMAL PTHREAD_MUTEX_RECURSIVE PTHREAD_MUTEX_RECURSIVE_NP
    PTHREAD_MUTEX_ROBUST PTHREAD_MUTEX_ROBUST_NP PTHREAD_MUTEX_STALLED PTHREAD_MUTEX_STALLED_NP
    PTHREAD_MUTEX_TIMED_NP PTHREAD_PRIO_INHERIT PTHREAD_PRIO_NONE PTHREAD_PRIO_PROTECT PTHREAD_PROCESS_PRIVATE
    PTHREAD_PROCESS_SHARED PTHREAD_RWLOCK_DEFAULT_NP PTHREAD_RWLOCK_PREFER_READER_NP
    PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP PTHREAD_RWLOCK_PREFER_WRITER_NP PTHREAD_SCOPE_PROCESS
    PTHREAD_SCOPE_SYSTEM a64l abort abs access acct adjtime alarm aligned_alloc arc4random arc4random_buf
    arc4random_uniform asctime asctime_r asprintf at_quick_exit atexit atof atoi atol atoll basename bcmp bcopy
    bind_textdomain_codeset bindtextdomain blkcnt64_t blkcnt_t blksize_t brk bsearch btowc bzero caddr_t calloc
    canonicalize_file_name chdir chmod chown chroot clearenv clearerr clearerr_unlocked clock clock_adjtime
    clock_getcpuclockid clock_getres clock_gettime clock_nanosleep clock_settime clock_t clockid_t clone close
    close_range closefrom comparison_fn_t confstr cookie_close_function_t cookie_io_functions_t
    cookie_read_function_t cookie_seek_function_t cookie_write_function_t copy_file_range cpu_set_t creat creat64
    crypt ctermid ctime ctime_r cuserid daddl daddr_t daemon daylight dcgettext dcngettext ddivl dev_t dfmal
    dgettext difftime div div_t dmull dngettext double_t dprintf drand48 drand48_data drand48_r drem dremf dreml
    dsqrtl dsubl dup dup2 dup3 duplocale dysize eaccess ecvt ecvt_r endusershell environ erand48 erand48_r error_t
    euidaccess execl execle execlp execv execve execveat execvp execvpe exit explicit_bzero f32addf128 f32addf32x
    f32addf64 f32addf64x f32divf128 f32divf32x f32divf64 f32divf64x f32fmaf128 f32fmaf32x f32fmaf64 f32fmaf64x
    f32mulf128 f32mulf32x f32mulf64 f32mulf64x f32sqrtf128 f32sqrtf32x f32sqrtf64 f32sqrtf64x f32subf128 f32subf32x
    f32subf64 f32subf64x f32xaddf128 f32xaddf64 f32xaddf64x f32xdivf128 f32xdivf64 f32xdivf64x f32xfmaf128
    f32xfmaf64 f32xfmaf64x f32xmulf128 f32xmulf64 f32xmulf64x f32xsqrtf128 f32xsqrtf64 f32xsqrtf64x f32xsubf128
    f32xsubf64 f32xsubf64x f64addf128 f64addf64x f64divf128 f64divf64x f64fmaf128 f64fmaf64x f64mulf128 f64mulf64x
    f64sqrtf128 f64sqrtf64x f64subf128 f64subf64x f64xaddf128 f64xdivf128 f64xfmaf128 f64xmulf128 f64xsqrtf128
    f64xsubf128 f_owner_ex faccessat fadd faddl fallocate fallocate64 fchdir fchmod fchmodat fchown fchownat fclose
    fcloseall fcntl fcntl64 fcvt fcvt_r fd_mask fd_set fdatasync fdiv fdivl fdopen feof feof_unlocked ferror
    ferror_unlocked fexecve fflush fflush_unlocked ffma ffmal ffs ffsl ffsll fgetc fgetc_unlocked fgetpos fgetpos64
    fgets fgets_unlocked fgetwc fgetwc_unlocked fgetws fgetws_unlocked file_handle fileno fileno_unlocked finite
    finitef finitel float_t flock flock64 flockfile fmemopen fmul fmull fopen fopen64 fopencookie fork fpathconf
    fpos64_t fpos_t fprintf fputc fputc_unlocked fputs fputs_unlocked fputwc fputwc_unlocked fputws fputws_unlocked
    fread fread_unlocked free freelocale freopen freopen64 fsblkcnt64_t fsblkcnt_t fscanf fseek fseeko fseeko64
    fsetpos fsetpos64 fsfilcnt64_t fsfilcnt_t fsid_t fsqrt fsqrtl fstat fstat64 fstatat fstatat64 fsub fsubl fsync
    ftell ftello ftello64 ftruncate ftruncate64 ftrylockfile funlockfile futimens futimes futimesat fwide fwprintf
    fwrite fwrite_unlocked fwscanf gamma gammaf gammal gcvt get_current_dir_name getc getc_unlocked getchar
    getchar_unlocked getcpu getcwd getdate getdate_err getdate_r getdelim getdomainname getdtablesize getegid
    getentropy getenv geteuid getgid getgroups gethostid gethostname getitimer getline getloadavg getlogin
    getlogin_r getopt getpagesize getpass getpgid getpgrp getpid getppid getpt getresgid getresuid getsid getsubopt
    gettext gettid gettimeofday getuid getumask getusershell getw getwc getwc_unlocked getwchar getwchar_unlocked
    getwd gid_t gmtime gmtime_r grantpt group_member id_t index initstate initstate_r ino64_t ino_t int16_t int32_t
    int64_t int8_t int_fast16_t int_fast32_t int_fast64_t int_fast8_t int_least16_t int_least32_t int_least64_t
    int_least8_t intmax_t intptr_t iovec isalnum isalnum_l isalpha isalpha_l isascii isatty isblank isblank_l
    iscanonical iscntrl iscntrl_l isctype isdigit isdigit_l iseqsig isgraph isgraph_l isinff isinfl islower
    islower_l isnanf isnanl isprint isprint_l ispunct ispunct_l issignaling isspace isspace_l isupper isupper_l
    iswalnum iswalnum_l iswalpha iswalpha_l iswblank iswblank_l iswcntrl iswcntrl_l iswctype iswctype_l iswdigit
    iswdigit_l iswgraph iswgraph_l iswlower iswlower_l iswprint iswprint_l iswpunct iswpunct_l iswspace iswspace_l
    iswupper iswupper_l iswxdigit iswxdigit_l isxdigit isxdigit_l iszero itimerspec itimerval jrand48 jrand48_r
    key_t l64a labs lchmod lchown lcong48 lcong48_r lconv ldiv ldiv_t lgamma_r lgammaf128_r lgammaf32_r lgammaf32x_r
    lgammaf64_r lgammaf64x_r lgammaf_r lgammal_r link linkat llabs lldiv lldiv_t locale_t localeconv localtime
    localtime_r lockf lockf64 loff_t lrand48 lrand48_r lseek lseek64 lstat lstat64 lutimes malloc max_align_t mblen
    mbrlen mbrtowc mbsinit mbsnrtowcs mbsrtowcs mbstate_t mbstowcs mbtowc memccpy memchr memcmp memcpy memfrob
    memmem memmove mempcpy memrchr memset mkdir mkdirat mkdtemp mkfifo mkfifoat mknod mknodat mkostemp mkostemp64
    mkostemps mkostemps64 mkstemp mkstemp64 mkstemps mkstemps64 mktemp mktime mode_t mrand48 mrand48_r
    name_to_handle_at nanosleep newlocale nexttoward nexttowardf nexttowardl ngettext nice nlink_t nrand48 nrand48_r
    nullptr_t obstack obstack_printf obstack_vprintf off64_t off_t on_exit open open64 open_by_handle_at
    open_memstream open_wmemstream openat openat64 optarg opterr optind optopt pathconf pause pclose perror pid_t
    pipe pipe2 popen posix_fadvise posix_fadvise64 posix_fallocate posix_fallocate64 posix_memalign posix_openpt
    pread pread64 printf profil program_invocation_name program_invocation_short_name pselect pthread_atfork
    pthread_attr_destroy pthread_attr_getaffinity_np pthread_attr_getdetachstate pthread_attr_getguardsize
    pthread_attr_getinheritsched pthread_attr_getschedparam pthread_attr_getschedpolicy pthread_attr_getscope
    pthread_attr_getsigmask_np pthread_attr_getstack pthread_attr_getstackaddr pthread_attr_getstacksize
    pthread_attr_init pthread_attr_setaffinity_np pthread_attr_setdetachstate pthread_attr_setguardsize
    pthread_attr_setinheritsched pthread_attr_setschedparam pthread_attr_setschedpolicy pthread_attr_setscope
    pthread_attr_setsigmask_np pthread_attr_setstack pthread_attr_setstackaddr pthread_attr_setstacksize
    pthread_attr_t pthread_barrier_destroy pthread_barrier_init pthread_barrier_t pthread_barrier_wait
    pthread_barrierattr_destroy pthread_barrierattr_getpshared pthread_barrierattr_init
    pthread_barrierattr_setpshared pthread_barrierattr_t pthread_cancel pthread_clockjoin_np pthread_cond_broadcast
    pthread_cond_clockwait pthread_cond_destroy pthread_cond_init pthread_cond_signal pthread_cond_t
    pthread_cond_timedwait pthread_cond_wait pthread_condattr_destroy pthread_condattr_getclock
    pthread_condattr_getpshared pthread_condattr_init pthread_condattr_setclock pthread_condattr_setpshared
    pthread_condattr_t pthread_create pthread_detach pthread_equal pthread_exit pthread_getaffinity_np
    pthread_getattr_default_np pthread_getattr_np pthread_getconcurrency pthread_getcpuclockid pthread_getname_np
    pthread_getschedparam pthread_getspecific pthread_join pthread_key_create pthread_key_delete pthread_key_t
    pthread_mutex_clocklock pthread_mutex_consistent pthread_mutex_consistent_np pthread_mutex_destroy
    pthread_mutex_getprioceiling pthread_mutex_init pthread_mutex_lock pthread_mutex_setprioceiling pthread_mutex_t
    pthread_mutex_timedlock pthread_mutex_trylock pthread_mutex_unlock pthread_mutexattr_destroy
    pthread_mutexattr_getprioceiling pthread_mutexattr_getprotocol pthread_mutexattr_getpshared
    pthread_mutexattr_getrobust pthread_mutexattr_getrobust_np pthread_mutexattr_gettype pthread_mutexattr_init
    pthread_mutexattr_setprioceiling pthread_mutexattr_setprotocol pthread_mutexattr_setpshared
    pthread_mutexattr_setrobust pthread_mutexattr_setrobust_np pthread_mutexattr_settype pthread_mutexattr_t
    pthread_once pthread_once_t pthread_rwlock_clockrdlock pthread_rwlock_clockwrlock pthread_rwlock_destroy
    pthread_rwlock_init pthread_rwlock_rdlock pthread_rwlock_t pthread_rwlock_timedrdlock pthread_rwlock_timedwrlock
    pthread_rwlock_tryrdlock pthread_rwlock_trywrlock pthread_rwlock_unlock pthread_rwlock_wrlock
    pthread_rwlockattr_destroy pthread_rwlockattr_getkind_np pthread_rwlockattr_getpshared pthread_rwlockattr_init
    pthread_rwlockattr_setkind_np pthread_rwlockattr_setpshared pthread_rwlockattr_t pthread_self
    pthread_setaffinity_np pthread_setattr_default_np pthread_setcancelstate pthread_setcanceltype
    pthread_setconcurrency pthread_setname_np pthread_setschedparam pthread_setschedprio pthread_setspecific
    pthread_spin_destroy pthread_spin_init pthread_spin_lock pthread_spin_trylock pthread_spin_unlock
    pthread_spinlock_t pthread_t pthread_testcancel pthread_timedjoin_np pthread_tryjoin_np pthread_yield ptrdiff_t
    ptsname ptsname_r putc putc_unlocked putchar putchar_unlocked putenv puts putw putwc putwc_unlocked putwchar
    putwchar_unlocked pwrite pwrite64 qecvt qecvt_r qfcvt qfcvt_r qgcvt qsort qsort_r quad_t quick_exit rand rand_r
    random random_data random_r rawmemchr read readahead readlink readlinkat realloc reallocarray realpath
    register_t remove rename renameat renameat2 revoke rewind rindex rmdir rpmatch sbrk scalb scalbf scalbl scanf
    sched_get_priority_max sched_get_priority_min sched_getaffinity sched_getcpu sched_getparam sched_getscheduler
    sched_param sched_rr_get_interval sched_setaffinity sched_setparam sched_setscheduler sched_yield secure_getenv
    seed48 seed48_r select sem_clockwait sem_close sem_destroy sem_getvalue sem_init sem_open sem_post sem_t
    sem_timedwait sem_trywait sem_unlink sem_wait setbuf setbuffer setdomainname setegid setenv seteuid setgid
    sethostid sethostname setitimer setlinebuf setlocale setlogin setns setpgid setpgrp setregid setresgid setresuid
    setreuid setsid setstate setstate_r settimeofday setuid setusershell setvbuf sigabbrev_np sigdescr_np sigevent
    signgam significand significandf significandl sigset_t size_t sleep snprintf socklen_t splice sprintf srand
    srand48 srand48_r srandom srandom_r sscanf ssize_t stat stat64 statx statx_timestamp stderr stdin stdout stpcpy
    stpncpy strcasecmp strcasecmp_l strcasestr strcat strchr strchrnul strcmp strcoll strcoll_l strcpy strcspn
    strdup strerror strerror_l strerror_r strerrordesc_np strerrorname_np strfromd strfromf strfromf128 strfromf32
    strfromf32x strfromf64 strfromf64x strfroml strfry strftime strftime_l strlen strncasecmp strncasecmp_l strncat
    strncmp strncpy strndup strnlen strpbrk strptime strptime_l strrchr strsep strsignal strspn strstr strtod
    strtod_l strtof strtof128 strtof128_l strtof32 strtof32_l strtof32x strtof32x_l strtof64 strtof64_l strtof64x
    strtof64x_l strtof_l strtok strtok_r strtol strtol_l strtold strtold_l strtoll strtoll_l strtoq strtoul
    strtoul_l strtoull strtoull_l strtouq strverscmp strxfrm strxfrm_l suseconds_t swab swprintf swscanf symlink
    symlinkat sync sync_file_range syncfs syscall sysconf system tcgetpgrp tcsetpgrp tee tempnam textdomain time
    time_t timegm timelocal timer_create timer_delete timer_getoverrun timer_gettime timer_settime timer_t timespec
    timespec_get timespec_getres timeval timex timezone tm tmpfile tmpfile64 tmpnam tmpnam_r toascii tolower
    tolower_l toupper toupper_l towctrans towctrans_l towlower towlower_l towupper towupper_l truncate truncate64
    ttyname ttyname_r ttyslot tzname tzset u_char u_int u_int16_t u_int32_t u_int64_t u_int8_t u_long u_quad_t
    u_short ualarm uid_t uint uint16_t uint32_t uint64_t uint8_t uint_fast16_t uint_fast32_t uint_fast64_t
    uint_fast8_t uint_least16_t uint_least32_t uint_least64_t uint_least8_t uintmax_t uintptr_t ulong umask ungetc
    ungetwc unlink unlinkat unlockpt unsetenv unshare useconds_t uselocale ushort usleep utimensat utimes va_list
    valloc vasprintf vdprintf vfork vfprintf vfscanf vfwprintf vfwscanf vhangup vmsplice vprintf vscanf vsnprintf
    vsprintf vsscanf vswprintf vswscanf vwprintf vwscanf wcpcpy wcpncpy wcrtomb wcscasecmp wcscasecmp_l wcscat
    wcschr wcschrnul wcscmp wcscoll wcscoll_l wcscpy wcscspn wcsdup wcsftime wcsftime_l wcslen wcsncasecmp
    wcsncasecmp_l wcsncat wcsncmp wcsncpy wcsnlen wcsnrtombs wcspbrk wcsrchr wcsrtombs wcsspn wcsstr wcstod wcstod_l
    wcstof wcstof128 wcstof128_l wcstof32 wcstof32_l wcstof32x wcstof32x_l wcstof64 wcstof64_l wcstof64x wcstof64x_l
    wcstof_l wcstok wcstol wcstol_l wcstold wcstold_l wcstoll wcstoll_l wcstombs wcstoq wcstoul wcstoul_l wcstoull
    wcstoull_l wcstouq wcswcs wcswidth wcsxfrm wcsxfrm_l wctob wctomb wctrans wctrans_l wctrans_t wctype wctype_l
    wctype_t wcwidth wint_t wmemchr wmemcmp wmemcpy wmemmove wmempcpy wmemset wprintf write wscanf""".split()
)
_SUFFIXES = ("", "f", "l", "f32", "f32x", "f64", "f64x", "f128")  # of the types of numbers
GLOBALS = _OTHERS.union(f"{name}{suffix}" for name in _FUNCTIONS for suffix in _SUFFIXES)
