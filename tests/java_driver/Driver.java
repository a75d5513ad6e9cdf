package generated.runtime;

import generated.Parameters;
import java.io.BufferedReader;
import java.io.InputStreamReader;
import java.io.PrintStream;
import java.math.BigInteger;
import java.nio.charset.StandardCharsets;
import java.util.ArrayList;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;

/** Judges values with a component's generated accessors: one line of JSON in, one line of hexadecimal answers out. */
public final class Driver {
    private final String text;
    private int at;

    private Driver(String text) {
        this.text = text;
    }

    /**
     * `judge NAME JSON`: data for the member NAME. `put NAME JSON`: the same, as a component sets it. `read NAME JSON`:
     * properties for it. `constraints JSON`: all values.
     */
    public static void main(String[] arguments) throws Exception {
        BufferedReader in = new BufferedReader(new InputStreamReader(System.in, StandardCharsets.UTF_8));
        PrintStream out = new PrintStream(System.out, false, StandardCharsets.UTF_8);
        Table table = Parameters.table();
        for (String line = in.readLine(); line != null; line = in.readLine()) {
            String[] words = line.split(" ");
            Object value = new Driver(words[words.length - 1]).value();
            if (words[0].equals("constraints")) {
                for (Constraint constraint : table.constraints()) {
                    out.print(constraint.holds(map(value)) ? 1 : 0);
                }
                out.println();
            } else if (words[0].equals("judge")) {
                Map<String, Object> data = new LinkedHashMap<>();
                data.put(words[1], value);
                out.println(answer(Kind.group(table.kind().members.get(words[1])), data, false));
            } else if (words[0].equals("put")) {
                Kind kind = Kind.group(table.kind().members.get(words[1]));
                Map<String, Object> data = new LinkedHashMap<>();
                Editing.put(kind, data, List.of(words[1]), value);
                out.println(answer(kind, data, false));
            } else {
                Map<String, String> properties = new LinkedHashMap<>();
                map(value).forEach((key, item) -> properties.put(key, (String) item));
                Kind kind = Kind.group(table.kind().members.get(words[1]));
                Reader reader = new Reader(properties, table.spellings(), "", Map.of());
                out.println(answer(kind, reader.read(kind), true));
            }
        }
        out.flush();
    }

    @SuppressWarnings("unchecked")
    private static Map<String, Object> map(Object value) {
        return (Map<String, Object>) value;
    }

    /** What is wrong, or each plain value by its path. */
    private static String answer(Kind kind, Object raw, boolean isText) {
        Taking taking = new Taking(isText);
        Object value = kind.take(raw, List.of(), taking);
        StringBuilder said = new StringBuilder(taking.problems.isEmpty() ? "fits" : "no");
        taking.problems.forEach(problem -> said.append(' ').append(hex(problem.message())));
        if (taking.problems.isEmpty()) {
            Map<String, Entry> entries = new LinkedHashMap<>();
            Editing.flat(kind, value, Map.of(), List.of(), false, entries);
            entries.forEach((key, entry) -> said.append(' ').append(hex(key)).append('=').append(hex(entry.text())));
        }
        return said.toString();
    }

    private static String hex(String text) {
        return java.util.HexFormat.of().formatHex(text.getBytes(StandardCharsets.UTF_8));
    }

    private Object value() {
        switch (text.charAt(at)) {
            case '{':
                return map();
            case '[':
                return list();
            case '"':
                return string();
            case 't':
                at += 4;
                return true;
            case 'f':
                at += 5;
                return false;
            case 'n':
                at += 4;
                return null;
            default:
                return number();
        }
    }

    private Map<String, Object> map() {
        Map<String, Object> made = new LinkedHashMap<>();
        for (at++; text.charAt(at) != '}';) {
            at += text.charAt(at) == ',' ? 1 : 0;
            String key = string();
            at++;
            made.put(key, value());
        }
        at++;
        return made;
    }

    private List<Object> list() {
        List<Object> made = new ArrayList<>();
        for (at++; text.charAt(at) != ']';) {
            at += text.charAt(at) == ',' ? 1 : 0;
            made.add(value());
        }
        at++;
        return made;
    }

    /** Texts come in hexadecimal: no escapes. */
    private String string() {
        int end = text.indexOf('"', at + 1);
        byte[] raw = java.util.HexFormat.of().parseHex(text.substring(at + 1, end));
        at = end + 1;
        return new String(raw, StandardCharsets.UTF_8);
    }

    private Object number() {
        int end = at;
        while (end < text.length() && ",]}".indexOf(text.charAt(end)) < 0) {
            end++;
        }
        String word = text.substring(at, end);
        at = end;
        return word.matches("-?[0-9]+") ? Texts.narrowed(new BigInteger(word)) : (Object) Double.parseDouble(word);
    }
}
