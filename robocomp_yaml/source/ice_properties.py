"""The properties of Ice 3.7 itself, without their prefix `Ice.`, and the values that Ice accepts.

Ice ignores an unknown property, and replaces most impossible values by a default, with a warning at the start at most.
The names are those of `config/PropertyNames.xml` of Ice 3.7.
"""

from __future__ import annotations

from functools import cache

from robocomp_yaml.patterns import pattern

PREFIX = "Ice."

_PROXY = """ EndpointSelection ConnectionCached PreferSecure LocatorCacheTimeout InvocationTimeout Locator Router
CollocationOptimized Context.*"""
_POOL = "Size SizeMax SizeWarn StackSize Serialize ThreadIdleTime ThreadPriority"
_ACM = " Timeout Heartbeat Close"
_NAMES = {
    "": """AcceptClassCycles BackgroundLocatorCacheUpdates BatchAutoFlush BatchAutoFlushSize CacheMessageBuffers
        ChangeUser ClassGraphDepthMax ClientAccessPolicyProtocol CollectObjects Compression.Level Config
        ConsoleListener EventLog.Source FactoryAssemblies HTTPProxyHost HTTPProxyPort IPv4 IPv6 ImplicitContext
        InitPlugins LogFile LogFile.SizeMax LogStdErr.Convert MessageSizeMax Nohup NullHandleAbort Package.* Plugin.*
        PluginLoadOrder PreferIPv6Address PreloadAssemblies PrintAdapterReady PrintProcessId PrintStackTraces
        ProgramName RetryIntervals SOCKSProxyHost SOCKSProxyPort ServerIdleTime StdErr StdOut SyslogFacility
        ThreadInterruptSafe ThreadPriority ToStringMode UseApplicationClassLoader UseOSLog UseSyslog
        UseSystemdJournal""",
    "ACM": _ACM,
    "ACM.Client": _ACM,
    "ACM.Server": _ACM,
    "Admin": """AdapterId DelayCreation Enabled Endpoints Facets InstanceName Logger.KeepLogs Logger.KeepTraces
        Logger.Properties MessageSizeMax ProxyOptions PublishedEndpoints ReplicaGroupId ServerId""",
    "Admin.ACM": _ACM,
    "Admin.Locator": _PROXY,
    "Admin.Router": _PROXY,
    "Admin.ThreadPool": _POOL,
    "Default": """CollocationOptimized EncodingVersion EndpointSelection Host InvocationTimeout LocatorCacheTimeout
        Package PreferSecure Protocol SlicedFormat SourceAddress Timeout""",
    "Default.Locator": _PROXY,
    "Default.Router": _PROXY,
    "Override": "CloseTimeout Compress ConnectTimeout Secure Timeout",
    "TCP": "Backlog RcvSize SndSize",
    "ThreadPool.Client": _POOL,
    "ThreadPool.Server": _POOL,
    "Trace": "Admin.Logger Admin.Properties Locator Network Protocol Retry Slicing ThreadPool",
    "UDP": "RcvSize SndSize",
    "Warn": "AMICallback Connections Datagrams Dispatch Endpoints UnknownProperties UnusedProperties",
}
"""A text that begins with a blank also has the property of the group itself: `Ice.ACM`."""

_NUMBERS = pattern(
    r"(?:Trace|Warn|ACM|Admin\.ACM|(?:Admin\.)?ThreadPool|TCP|UDP)\..*|(?:Admin\.)?MessageSizeMax|IPv[46]|Nohup"
    r"|(?:Use|Print|Accept|Cache|Batch)\w+|(?:HTTP|SOCKS)ProxyPort|Override\.\w+|\w+Max|ServerIdleTime|LogFile\.SizeMax"
    r"|Default\.(?:CollocationOptimized|\w*Timeout|PreferSecure|SlicedFormat)|PreferIPv6Address|Compression\.Level"
    r"|Admin\.(?:DelayCreation|Enabled|Logger\.Keep\w+)|BackgroundLocatorCacheUpdates|LogStdErr\.Convert\Z"
)
_NUMBER = pattern(r"\s*[-+]?\d+\s*\Z")
_WORDS = {
    "Default.EncodingVersion": ("1.0", "1.1"),
    "Default.EndpointSelection": ("Random", "Ordered"),
    "ImplicitContext": ("None", "PerThread", "Shared"),
    "ToStringMode": ("ASCII", "Compat", "Unicode"),
}


@cache
def names() -> frozenset[str]:
    """The names of all properties; one that ends in `*` is a prefix."""
    found = set[str]()
    for group, members in _NAMES.items():
        found.update(f"{group}.{name}" if group else name for name in members.split())
        found.update((group,) if members[0] == " " else ())
    return frozenset(found)


def is_known(name: str) -> bool:
    """Whether Ice has a property of this name, which is without the prefix."""
    every = names()
    return name in every or any(name.startswith(one[:-1]) for one in every if one.endswith("*"))


def wanted(name: str, value: str) -> str:
    """What Ice expects of a property instead of this value; '' if the value is right."""
    if words := _WORDS.get(name, ()):
        return "" if value in words else f"one of {', '.join(words)}"
    return "a whole number" if _NUMBERS.match(name) and not _NUMBER.match(value) else ""


def words(name: str) -> tuple[str, ...]:
    """The only values that a property can have, if these are words."""
    return _WORDS.get(name, ())
