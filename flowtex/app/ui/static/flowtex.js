// Built from client/src by client/build.js; change that instead.
"use strict";(()=>{function clamp(x,low,high){return Math.min(Math.max(x,low),high)}function drawsFloats(gl){return["EXT_color_buffer_float","EXT_color_buffer_half_float"].some(name=>gl.getExtension(name)!==
null)}var CLOSE_KEY="Escape",HELP_KEY="?";function hasModifier(event){return event.ctrlKey||event.metaKey||event.altKey}function forwardKeys(root,event){event.target===document.body&&!event.defaultPrevented&&!root.dispatchEvent(new KeyboardEvent(
"keydown",event))&&event.preventDefault()}var Lifetime=class{controller=new AbortController;observers=new Set;timers=new Set;globalListeners=0;get isOver(){return this.
controller.signal.aborted}listen(target,kind,call,options={}){(target===document||target===window)&&(this.globalListeners+=
1);let{signal}=this.controller;target.addEventListener(kind,call,{...options,signal})}later(call,delay){let timer=setTimeout(
()=>{this.timers.delete(timer),call()},delay);return this.timers.add(timer),timer}cancel(timer){timer!==null&&(clearTimeout(
timer),this.timers.delete(timer))}observe(observer,element){observer.observe(element),this.observers.add(observer)}watch(observer,element,what){
observer.observe(element,what),this.observers.add(observer)}stats(){let{globalListeners:listeners,observers,timers}=this;
return{listeners,observers:observers.size,timers:timers.size}}end(){this.controller.abort(),this.globalListeners=0;for(let observer of this.
observers)observer.disconnect();this.observers.clear();for(let timer of this.timers)clearTimeout(timer);this.timers.clear()}};
function throttled(later,wait,call){let next=null,running=!1,run=()=>{if(running=next!==null,!next)return;let{value}=next;
next=null,call(value),later(run,wait)};return value=>{next={value},running||run()}}var FINER=1/16;function fromHalf(bits){let exponent=bits>>10&31,part=bits&1023,size;return exponent===0?size=part*2**-24:exponent===31?
size=part?NaN:1/0:size=(1024+part)*2**(exponent-25),bits&32768?-size:size}var HALVES=Float32Array.from({length:65536},(_,bits)=>fromHalf(
bits)),SINGLE=new Float32Array(1),BITS=new Uint32Array(SINGLE.buffer);var OPERATIONS=new Map(Object.entries({"+":(a,b)=>a+b,"*":(a,b)=>a*b,"/":(a,b)=>a/b,"^":(a,b)=>a**b,"<":(a,b)=>+(a<b),">":(a,b)=>+(a>
b),"<=":(a,b)=>+(a<=b),">=":(a,b)=>+(a>=b),neg:a=>-a,ln:Math.log,mod:(a,b)=>a-b*Math.floor(a/b),where:(a,b,c)=>a?b:c,min:(a,b)=>Math.
min(a,b),max:(a,b)=>Math.max(a,b)}));for(let name of"sin cos tan asin acos atan atan2 sinh cosh tanh exp log log2 log10 \
sqrt abs sign floor ceil hypot".split(" "))OPERATIONS.set(name,Math[name]);function loadFiles(address,partsOfFile){return async(key,steps,signal,_has,whole="whole")=>{let name=address()+[String(key??
whole),...steps].join("."),answer=await fetch(name,{signal});if(!answer.ok)throw new Error(`${name}: ${answer.status}`);
return partsOfFile(await answer.arrayBuffer())}}var page=()=>window,vue=()=>page().Vue,trame=()=>page().trame;var DRAWN_MS=33,MESSAGE_MS=100,SUCCESSOR_MS=1500,GAP_PX=2,STREAM="trame.rca.topic.stream",session=()=>trame().client.getConnection().
getSession(),SOFTWARE=/swiftshader|llvmpipe|softpipe|software|basic render/i,CHOICE="flowtex painter";function bestPainter(){
let gl=document.createElement("canvas").getContext("webgl2");if(!gl||!drawsFloats(gl))return"server";let name=gl.getExtension(
"WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL??gl.RENDERER;return SOFTWARE.test(String(gl.getParameter(name)))?"\
server":"browser"}function chosen(painter){try{return painter&&sessionStorage.setItem(CHOICE,painter),sessionStorage.getItem(
CHOICE)}catch{return painter??null}}var TrameView=class{props;emit;element;name=Math.random().toString(36).slice(2);ended=new AbortController;client=null;view=null;painter="\
browser";scenes=[];loaded=[];area="";size="";early=null;came=0;shown=0;subscription=null;watcher=new ResizeObserver(()=>this.
resize());constructor(props,emit,element){this.props=props,this.emit=emit,this.element=element;let listener=event=>this.
view&&forwardKeys(this.view.first.root,event);document.addEventListener("keydown",listener,{signal:this.ended.signal})}async paint(painter){
this.painter=chosen(painter)??bestPainter();let start=await trame().trigger(this.props.begin,[this.painter]),early=this.
early=[],address=new URL(start.client,document.baseURI).href;if(this.client??=await import(address),this.ended.signal.aborted)
return;this.area=start.area,this.size="",this.subscription??=session().subscribe(STREAM,([frame])=>{this.takeFrame(frame)}),
this.view?.dispose(),this.view?.remove();let view=this.view=new this.client.FlowtexView;view.options=this.options(),this.
connect(view),this.element.append(view),this.scenes=[],this.early=null,await Promise.all([start,...early].map(changes=>this.
take(changes)))}options(){return{rebuild:!0,named:!0,streamed:this.painter==="server",onColours:choice=>this.tell("colou\
rs",choice)}}connect(view){let wait=this.painter==="server"?DRAWN_MS:MESSAGE_MS;for(let name of["camera","time","clock"]){
let send2=throttled(setTimeout,wait,said=>this.tell(name,...said));view.addEventListener(name,event=>send2([event.detail,
view.first?.header?.place]))}for(let name of["playing","setting"])view.addEventListener(name,event=>this.tell(name,event.
detail))}tell(name,value,place=null){this.emit(name,{value,page:this.name,place})}async take(changes){let{view,early}=this;
if(early)return void early.push(changes);if(!view||changes.by===this.name)return;let{scenes,settings,camera,time,timeBeside,
clock,playing}=changes,loading=scenes&&this.show(scenes),{viewers,first}=view,isStill=!first.playing;for(let viewer of viewers){
for(let[name,value]of Object.entries(settings??{}))viewer.followSetting(name,value);camera!==void 0&&viewer.setCamera(camera),
time!==void 0&&isStill&&viewer.followTime(time),clock!==void 0&&isStill&&viewer.setClock(clock)}typeof timeBeside=="numb\
er"&&viewers[1]?.setTime(timeBeside),playing===!0?first.play():playing===!1&&first.pause(),await loading}async show(scenes){
let{view,scenes:before}=this;if(!view)return;this.scenes=scenes;let loads=scenes.map((_,n)=>this.load(n));if(before.length!==
scenes.length){this.loaded=[],view.open(scenes.length,n=>({reader:this.reader(n),source:this.painter==="browser"?{load:loads[n],
hasSteps:!0,hasMarks:!0}:void 0})),this.watcher.disconnect();for(let{stage}of view.viewers)this.watcher.observe(stage)}let fill=async(viewer,n)=>{
let{generation}=scenes[n].header,isThere=this.loaded[n]===generation,name=this.painter==="server"?"controls":isThere?"co\
lours":void 0;viewer.setHeader(scenes[n].header);try{let parts=await loads[n](null,[],void 0,void 0,name);if(this.scenes!==
scenes)return;name||viewer.keepParts(parts.map(part=>part.name));for(let part of parts)viewer.setPart(part);this.loaded[n]=
generation}catch(error){this.scenes===scenes&&viewer.panel.fail("The flow could not be loaded.",String(error))}this.painter===
"server"&&viewer.sharp&&(this.size=""),viewer.change()},filled=view.viewers.map(fill);this.resize(),await Promise.all(filled),
this.resize()}load(n){let address=()=>this.scenes[n]?.parts??"",load=loadFiles(address,file=>this.client?.partsOfFile(file)??
[]);return async(...request)=>{let asked=address();try{return await load(...request)}catch(error){if(!request[1].length||
(await new Promise(resolve=>setTimeout(resolve,asked===address()?SUCCESSOR_MS:0)),asked===address()))throw error;return[]}}}reader(n){
return(at,path)=>{let time=this.view?.viewers[n]?.player.time;return trame().trigger(this.props.read,[n,{...at,path,time}])}}resize(){
let{view,area}=this;if(!view?.viewers.length||!area)return;view.first.resize();let{width,height}=view.first.canvas,count=view.
viewers.length,size={w:count*width+(count-1)*GAP_PX,h:height,p:1},text=JSON.stringify(size);text!==this.size&&(this.size=
text,session().call("trame.rca.size",[area,"view",size]))}async takeFrame({name,meta,content}){if(name!==this.area||this.
painter!=="server")return;let number=this.came+=1,picture=await createImageBitmap(new Blob([content],{type:meta.type})),
seconds=performance.now()/1e3;if(session().call("trame.rca.event",[name,this.name,{number:meta.number,seconds}]),number<
this.shown||this.painter!=="server")return;this.shown=number;let{view}=this,whole=(view?.viewers.length??1)*(view?.first.
canvas.width??1);view?.paint(picture,Math.max(Math.round(GAP_PX*picture.width/whole),1),meta.sharp),picture.close()}dispose(){
this.ended.abort(),this.watcher.disconnect(),this.subscription&&session().unsubscribe(this.subscription),this.view?.dispose()}},
browser={name:"flowtex-client",props:["begin","read"],emits:["camera","time","clock","playing","setting","colours"],setup(props,{
emit,expose}){let{h,ref,onMounted,onBeforeUnmount}=vue(),place=ref(null),view=null;return onMounted(()=>{place.value&&(view=
new TrameView(props,emit,place.value),view.paint())}),onBeforeUnmount(()=>view?.dispose()),expose({take:changes=>{view?.
take(changes)},paint:painter=>{view?.paint(painter)}}),()=>h("div",{ref:place})}};var DELAY_MS=400,GAP_PX2=10;function put(box,owner){let at=owner.getBoundingClientRect(),{offsetWidth:width,offsetHeight:height}=box,
middle=[at.left+(at.width-width)/2,at.top+(at.height-height)/2],below=[middle[0],at.bottom+GAP_PX2],above=[middle[0],at.
top-height-GAP_PX2],places={start:[at.left-width-2*GAP_PX2,middle[1]],end:[at.right+2*GAP_PX2,middle[1]],top:above},[left,
top]=places[owner.dataset.side??""]??below;(left<0||left+width>innerWidth)&&([left,top]=below),top+height>innerHeight&&([
left,top]=above),box.style.left=`${clamp(left,4,innerWidth-width-4)}px`,box.style.top=`${Math.max(top,4)}px`}var Hint=class{box;owner=null;timer=0;byKeyboard=!1;constructor(box){
this.box=box}show(owner){this.box.textContent=owner.dataset.hint??"",this.box.hidden=!this.box.textContent,put(this.box,
owner)}hide=event=>{event&&(this.byKeyboard=event.type==="keydown"),clearTimeout(this.timer),this.box.hidden=!0};scroll=()=>{
this.box.hidden=!0};leave=()=>{this.hide(),this.owner=null};take(target,delay){let owner=target instanceof Element?target.
closest("[data-hint]"):null;owner===this.owner&&owner||(this.leave(),this.owner=owner,owner&&(this.timer=window.setTimeout(
()=>this.show(owner),delay)))}point=event=>{event.pointerType!=="touch"&&this.take(event.target,DELAY_MS)};focus=event=>{
this.byKeyboard&&this.take(event.target,0)}},hints={name:"flowtex-hints",setup(){let{h,ref,onMounted,onBeforeUnmount}=vue(),
place=ref(null),ended=new AbortController;return onMounted(()=>{if(!place.value)return;let hint=new Hint(place.value),options={
signal:ended.signal,capture:!0};window.addEventListener("pointerover",hint.point,options),window.addEventListener("focus\
in",hint.focus,options);for(let name of["focusout","blur"])window.addEventListener(name,hint.leave,options);for(let name of[
"pointerdown","keydown"])window.addEventListener(name,hint.hide,options);window.addEventListener("scroll",hint.scroll,options),
document.documentElement.addEventListener("pointerleave",hint.leave,{signal:ended.signal})}),onBeforeUnmount(()=>ended.abort()),
()=>h("div",{ref:place,role:"tooltip",class:"flowtex-tooltip",hidden:!0})}};var isShown=element=>element.getClientRects().length>0,Focus=class{had=[];current=null;fallback;constructor(scope,lifetime,fallback){
this.fallback=fallback,lifetime.listen(scope,"focusin",({target})=>{let element=target;this.had=this.had.filter(each=>each!==
element&&each.isConnected),this.had.push(element),this.current=element}),lifetime.listen(scope,"focusout",({target})=>{queueMicrotask(
()=>{this.current===target&&isShown(this.current)&&(this.current=null)})})}keep(){let lost=this.current;if(!lost||isShown(
lost))return;let shown=this.had.filter(isShown);(shown.length?shown[shown.length-1]:this.fallback(lost))?.focus({preventScroll:!0})}};var TOGGLES={[CLOSE_KEY]:"close",t:"theme",[HELP_KEY]:"help"},OWNERS="input, textarea, select, [contenteditable], [role=\
slider], .v-overlay--active";function press(event,emit){let[target]=event.composedPath(),{key}=event,isClose=key===CLOSE_KEY;
hasModifier(event)||!(key in TOGGLES)||!isClose&&target instanceof Element&&target.closest(OWNERS)||(emit("toggle",TOGGLES[key]),
isClose||event.preventDefault())}function takeLink(emit){let{hash,pathname,search}=window.location;hash.length<=1||(window.
history.replaceState(window.history.state,"",pathname+search),emit("linked",hash))}var keys={name:"flowtex-keys",emits:[
"toggle","linked"],setup(_,{emit}){let lifetime=new Lifetime,capture={capture:!0};return vue().onMounted(()=>{lifetime.listen(
window,"keydown",event=>press(event,emit),capture);let focus=new Focus(document,lifetime,()=>document.querySelector(".fl\
owtex")),keep=()=>requestAnimationFrame(()=>focus.keep());for(let kind of["keydown","click"])lifetime.listen(window,kind,
keep,capture);lifetime.listen(window,"hashchange",()=>takeLink(emit)),takeLink(emit)}),vue().onBeforeUnmount(()=>lifetime.
end()),()=>null}};async function send(file,address){let query=new URLSearchParams({name:file.name});try{let answer=await fetch(`${address}\
?${query.toString()}`,{method:"POST",body:file});return answer.ok?"":await answer.text()}catch{return`${file.name}: coul\
d not be sent`}}var upload={name:"flowtex-upload",props:["address","accept"],emits:["problem","busy"],setup(props,{emit}){
let{h,ref,onMounted,onBeforeUnmount}=vue(),isOver=ref(!1),input=ref(null),ended=new AbortController,take=async files=>{for(let file of files??
[]){emit("busy",`Sending ${file.name}`);let problem=await send(file,props.address);emit("busy",""),problem&&emit("proble\
m",problem)}},hasFiles=({dataTransfer})=>dataTransfer?.types.includes("Files")??!1,over=event=>{hasFiles(event)&&(event.
preventDefault(),isOver.value=!0)},leave=event=>{event.relatedTarget||(isOver.value=!1)},drop=event=>{isOver.value=!1,hasFiles(
event)&&(event.preventDefault(),take(event.dataTransfer?.files))};onMounted(()=>{let options={signal:ended.signal};window.
addEventListener("dragover",over,options),window.addEventListener("dragleave",leave,options),window.addEventListener("dr\
op",drop,options)}),onBeforeUnmount(()=>ended.abort());let change=()=>{take(input.value?.files).then(()=>input.value&&(input.
value.value=""))},choose={ref:input,type:"file",accept:props.accept,onChange:change,hidden:!0};return()=>h("div",{class:"\
flowtex-upload"},[h("input",{...choose,"aria-label":"Open file"}),h("button",{class:"flowtex-link",onClick:()=>input.value?.
click()},"Open file…"),h("div",{class:"flowtex-drop",hidden:!isOver.value},`Drop it here: ${props.accept}`)])}};function linked(hash){let folder=new URL(".",document.baseURI),secret=sessionStorage.getItem(`flowtex ${folder.pathname}\
 secret`);return secret&&(folder.search=new URLSearchParams({secret}).toString()),folder.href+hash}Object.assign(window,
{flowtex_page:{install(app){for(let component of[browser,hints,keys,upload])app.component(component.name,component);Object.
assign(app.config.globalProperties,{flowtex_address:linked,flowtex_copy:text=>navigator.clipboard?.writeText(text)})}}});})();
